// The programs that the page exports of its templates and exercises, and the page's verdicts on the same code.
import "../../../apps/web/vendor/codemirror/editor"; // in the page, scripts of their own
import { pointTemplates } from "../../../apps/web/domains";
import { exercises } from "../../../apps/web/exercises";
import { exported } from "../../../apps/web/export";
import { templates } from "../../../apps/web/templates";
import { checked } from "./exercises";

interface Exported { name: string; program: string; states: Record<string, string> }

export function exportsOf(module: WebAssembly.Module): Exported[] {
  const all: [string, { code: string; ground: string }][] = [...Object.entries(templates), ...Object.entries(pointTemplates), ...exercises.map((one): [string, typeof one] => [one.name, one])];
  return all.map(([name, { code, ground }]) => ({
    name: name.replace(/\W/g, "_"), program: exported("program", code, ground).text,
    states: Object.fromEntries(checked(module, code, ground, [[60, 0]]).verdicts.map((v) => [v.name, v.state])),
  }));
}
