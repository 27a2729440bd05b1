// RMSE against N, one chart per region, drawn by the core; a chart opens large.
import { el, made } from "./dom";
import { Model } from "./model";

/** The chart in a dialog, as large as the window. */
function enlarge(markup: string, title: string): void {
  const dialog: HTMLDialogElement = el("dialog", { class: "large", "aria-label": title, onclose: () => dialog.remove() }, made(markup),
    el("form", { method: "dialog" }, el("button", {}, "Close")));
  document.body.append(dialog);
  dialog.showModal();
}

/** The charts of the model's measurements, unless it opens something else meanwhile. */
export async function showLadders(root: HTMLElement, model: Model): Promise<void> {
  const { described, shown } = model;
  const charts = await Promise.all(described.regions.map(async ({ name }) => {
    const series = shown.map((s) => ({
      arm: s.name, band: s.bands[name] ?? [],
      points: s.sampleCounts.map((r) => [r.n, Number(r.metrics.metrics[`rmse.${name}`]!.value)]).filter(([, y]) => y! > 0 && Number.isFinite(y)),
    }));
    if (series.every(({ points }) => points.length === 0)) return undefined;
    return model.chart(() => described === model.described, { region: name, series });
  }));
  if (described !== model.described || charts.some((chart) => chart === undefined)) return;
  const held = root.contains(document.activeElement) ? [...root.querySelectorAll("button")].indexOf(document.activeElement as HTMLButtonElement) : -1;
  root.replaceChildren(...charts.map((chart, k) => el("figure", { class: "narrow" }, made(chart!),
    el("button", { type: "button", class: "plain", onclick: () => enlarge(chart!, `RMSE of ${described.regions[k]!.name} against N`) }, "Larger"))));
  if (held >= 0) root.querySelectorAll("button")[held]?.focus();
}
