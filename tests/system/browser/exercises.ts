// The samplers of the page in node, checked as the page checks them: those of the exercises before and after their
// repair, and the templates.
import { Api } from "../../../apps/web/api";
import { pointTemplates, returning } from "../../../apps/web/domains";
import { exercises } from "../../../apps/web/exercises";
import { introduce } from "../../../apps/web/jobs";
import { grounds, templates } from "../../../apps/web/templates";
import { userSampler, UserSampler } from "../../../apps/web/user";
import { evaluations, four } from "../../../apps/web/workshop_settings";

import "../../../apps/web/vendor/codemirror/editor"; // in the page, scripts of their own

interface Verdict { name: string; state: string; message: string; hidden: Record<string, number> }
declare const global: Record<string, unknown>;

/** The page's answer to this code: its state, and its verdicts. */
export function checked(module: WebAssembly.Module, code: string, ground: string, wo = four): { state: string; verdicts: Verdict[] } {
  global["self"] = global;
  const take = userSampler(() => {});
  (global["crescentUser"] as (make: () => unknown) => void)(new Function(`"use strict";\n${returning(code)}`) as () => unknown);
  const user = take() as UserSampler;
  const api = new Api(module, user.calls), { lobe, lambert, sharpness, light } = grounds[ground]!;
  introduce(user, api);
  return api.json("user_checked", { sampler: "", surface: { lobe, lambert, sharpness }, light, wo, evaluations });
}

/** A line for each sampler; throws if one is not as it should be. */
export function exerciseLines(module: WebAssembly.Module): string[] {
  const lines: string[] = [], bad: string[] = [];
  const state = (code: string, ground: string): [string, string] => {
    const { state, verdicts } = checked(module, code, ground), first = verdicts.find((v) => v.state === "wrong" || v.state === "error") ?? verdicts.find((v) => v.state === "inconclusive");
    return [state, first ? `${first.name}: ${first.message}` : ""];
  };
  for (const { name, code, ground, repair } of exercises) {
    const [before, why] = state(code, ground), [after, left] = repair ? state(code.replace(repair[0], () => repair[1]), ground) : ["", ""];
    lines.push(`${name}: ${before}${after ? `, then ${after}` : ""}; ${why} ${left}`);
    if (repair ? before !== "wrong" || after !== "right" : before !== "inconclusive") bad.push(lines[lines.length - 1]!);
  }
  for (const [name, { code, ground }] of [...Object.entries(templates), ...Object.entries(pointTemplates)]) {
    const [found, why] = state(code, ground);
    lines.push(`template ${name}: ${found}`);
    if (found !== "right") bad.push(`template ${name}: ${found}; ${why}`);
  }
  if (bad.length > 0) throw new Error(bad.join("\n"));
  return lines;
}
