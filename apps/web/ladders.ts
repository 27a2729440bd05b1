// RMSE against N, one chart per region, drawn by the core.
import { el, made } from "./dom";
import { Model } from "./model";

/** The charts of the model's measurements, unless it opens something else meanwhile. */
export async function showLadders(root: HTMLElement, model: Model): Promise<void> {
  const { described, shown } = model;
  const charts = await Promise.all(described.regions.map(async ({ name }) => {
    const series = shown.map((s) => ({
      arm: s.name,
      points: s.sampleCounts.map((r) => [r.n, Number(r.metrics.metrics[`rmse.${name}`]!.value)]).filter(([, y]) => y! > 0 && Number.isFinite(y)),
    }));
    return model.chart(() => described === model.described, { region: name, series });
  }));
  if (described !== model.described || charts.some((chart) => chart === undefined)) return;
  root.replaceChildren(...charts.map((chart) => el("figure", { class: "narrow" }, made(chart!))));
}
