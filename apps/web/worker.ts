// A worker: its first message is the compiled module, every other one a job.
import { Answering, failure, Job, Reply } from "./jobs";

interface Scope {
  onmessage: ((event: MessageEvent) => void) | null;
  postMessage(message: Reply, transfer: Transferable[]): void;
}
const scope = self as unknown as Scope;
const keptPixels = 300_000; // 60 MB
let answering: Answering | undefined;

scope.onmessage = ({ data }: MessageEvent): void => {
  if (!answering) {
    answering = new Answering(data as WebAssembly.Module, keptPixels);
    scope.postMessage({ id: -1, size: answering.size }, []);
    return;
  }
  const { id, job } = data as { id: number; job: Job };
  try {
    const answer = answering.answer(job);
    scope.postMessage({ id, answer, size: answering.size }, answer.bytes ?? []);
  } catch (error) {
    scope.postMessage({ id, error: failure(error), size: answering.size }, []);
  }
};
