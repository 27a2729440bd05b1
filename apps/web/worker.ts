// A worker: its first message is the compiled module, every other one a job. Behind this script there may be the user's
// sampler (apps/web/user.ts).
import { Answering, failure, Job, Reply } from "./jobs";
import { userSampler } from "./user";

interface Scope {
  onmessage: ((event: MessageEvent) => void) | null;
  postMessage(message: Reply, transfer: Transferable[]): void;
}
const scope = self as unknown as Scope, post = scope.postMessage.bind(scope);
const keptPixels = 300_000; // 60 MB
const often = 500; // ms between two signs of life
let lastSign = 0;
/** A reply to no job, now and then: the user's functions return. */
function proceeds(): void {
  const now = performance.now();
  if (now - lastSign < often) return;
  lastSign = now;
  post({ id: -1 }, []);
}
const take = userSampler(proceeds);
let answering: Answering | undefined;

async function respondTo(data: unknown): Promise<void> {
  let id = -1;
  try {
    if (!answering) {
      answering = new Answering(data as WebAssembly.Module, keptPixels, await take());
      post({ id, size: answering.size }, []);
      return;
    }
    const asked = data as { id: number; job: Job };
    id = asked.id;
    const answer = await answering.answer(asked.job);
    post({ id, answer, size: answering.size }, answer.bytes ?? []);
  } catch (error) {
    post({ id, error: failure(error), size: answering?.size ?? 0 }, []);
  }
}

let last = Promise.resolve(); // jobs in their order: one may wait for a graphics processor
scope.onmessage = ({ data }: MessageEvent): void => { last = last.then(() => respondTo(data)); };
