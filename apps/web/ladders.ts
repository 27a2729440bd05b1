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
    return model.chart(() => described === model.described, { region: name, series }).catch(() => undefined);
  }));
  if (described !== model.described || charts.some((chart) => chart === undefined)) return;
  const figures = [...root.querySelectorAll<HTMLElement>("figure[data-chart]")];
  if (figures.length !== charts.length || figures.some((figure, k) => figure.dataset["chart"] !== described.regions[k]!.name)) {
    figures.splice(0, figures.length, ...described.regions.map(({ name }) => {
      const place = el("div"), figure = el("figure", { class: "narrow", "data-chart": name }, place,
        el("button", { type: "button", class: "plain", "aria-label": `a larger chart of ${name}`, onclick: () => enlarge(place.innerHTML, `RMSE of ${name} against N`) }, "Larger"));
      return figure;
    }));
    root.replaceChildren(...figures);
  }
  figures.forEach((figure, k) => figure.firstElementChild!.replaceChildren(made(charts[k]!))); // its button stays
}
