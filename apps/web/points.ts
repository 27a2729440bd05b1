// Draws of points beside what their pdf expects, by bins: bars over a line or a set, a map of another domain.

interface Line { kind: "line"; axis: string; entries: boolean; edges: number[]; observed: number[]; expected: number[] }
interface Bins {
  kind: "map"; rings: number; sectors: number; observed: number[]; expected: number[]; sd: number[];
  ring_axis: string; sector_axis: string; ring_labels: string[]; sector_labels: string[];
}
/** The answer of user_points_drawn, apps/web/user_points.cpp. */
export type PointPicture = Line | Bins | { kind: "" };

export const pointLayers: [string, string][] = [["deviation", "draws less what the pdf expects"], ["observed", "its draws"], ["expected", "what the pdf expects"]];
const captions: Record<string, string> = {
  deviation: "red: more draws than the pdf expects, blue: fewer; full colour at four standard deviations",
  observed: "draws by bin", expected: "what the pdf expects by bin, in the scale of the draws",
};

const paper = "#141517", ink = "#e8e6e3", bar = "#5b8fd6", line = "#f2a33a", margin = { left: 46, bottom: 34, top: 10, right: 12 };
const short = (x: number): string => String(Number(x.toPrecision(3)));

function frame(pen: CanvasRenderingContext2D, size: number): { width: number; height: number } {
  pen.setTransform(1, 0, 0, 1, 0, 0);
  pen.fillStyle = paper;
  pen.fillRect(0, 0, size, size);
  pen.font = "12px system-ui, sans-serif";
  return { width: size - margin.left - margin.right, height: size - margin.top - margin.bottom };
}

function words(pen: CanvasRenderingContext2D, text: string, x: number, y: number, align: CanvasTextAlign): void {
  pen.fillStyle = ink;
  pen.textAlign = align;
  pen.fillText(text, x, y);
}

function drawBars(pen: CanvasRenderingContext2D, size: number, p: Line): string {
  const { width, height } = frame(pen, size), first = p.edges[0]!, span = p.edges.at(-1)! - first;
  const perLength = (n: number, k: number): number => n / (p.edges[k + 1]! - p.edges[k]!);
  const density = p.observed.map(perLength), expected = p.expected.map(perLength);
  const top = Math.max(...density, ...expected) * 1.05 || 1;
  const x = (at: number): number => margin.left + (width * (at - first)) / span, y = (value: number): number => margin.top + height * (1 - value / top);
  pen.fillStyle = bar;
  density.forEach((value, k) => pen.fillRect(x(p.edges[k]!), y(value), Math.max(x(p.edges[k + 1]!) - x(p.edges[k]!) - 1, 0.5), y(0) - y(value)));
  pen.strokeStyle = line;
  pen.lineWidth = 2;
  pen.beginPath();
  expected.forEach((value, k) => {
    pen[k === 0 ? "moveTo" : "lineTo"](x(p.edges[k]!), y(value));
    pen.lineTo(x(p.edges[k + 1]!), y(value));
  });
  pen.stroke();
  const ends: [number, number] = p.entries ? [first, first + span - 1] : [first, first + span]; // entry k is drawn from k to k + 1
  for (const share of [0, 0.5, 1]) {
    const at = ends[0] + share * (ends[1] - ends[0]), value = p.entries ? Math.round(at) : at;
    words(pen, short(value), Math.min(x(value + (p.entries ? 0.5 : 0)), size - margin.right - 6), size - margin.bottom + 14, "center");
  }
  words(pen, p.axis, margin.left + width / 2, size - 5, "center");
  words(pen, "0", margin.left - 5, y(0), "right");
  return `bars: the draws by ${p.entries ? "entry" : "interval"}; the line: what the pdf expects`;
}

function drawMap(pen: CanvasRenderingContext2D, size: number, p: Bins, layer: string): string {
  const { width, height } = frame(pen, size), top = Math.max(...p.observed, ...p.expected) || 1;
  for (let ring = 0; ring < p.rings; ++ring)
    for (let sector = 0; sector < p.sectors; ++sector) {
      const k = ring * p.sectors + sector, sd = Math.max(p.sd[k] ?? Math.sqrt(p.expected[k]!), 1), off = (p.observed[k]! - p.expected[k]!) / sd / 4;
      const strength = Math.min(Math.abs(off), 1), shade = Math.min((layer === "observed" ? p.observed : p.expected)[k]! / top, 1);
      pen.fillStyle = layer === "deviation" ? `rgb(${off > 0 ? "230 90 70" : "90 140 230"} / ${strength})` : `rgb(240 240 235 / ${shade})`;
      const x0 = Math.round((width * sector) / p.sectors), x1 = Math.round((width * (sector + 1)) / p.sectors);
      const y0 = Math.round((height * ring) / p.rings), y1 = Math.round((height * (ring + 1)) / p.rings);
      pen.fillRect(margin.left + x0, margin.top + y0, x1 - x0, y1 - y0);
    }
  pen.strokeStyle = "#55585c";
  pen.lineWidth = 1;
  pen.strokeRect(margin.left - 0.5, margin.top - 0.5, width + 1, height + 1);
  p.ring_labels.forEach((text, k) => words(pen, text, margin.left - 5, margin.top + (height * k) / 4 + 4, "right"));
  p.sector_labels.forEach((text, k) => words(pen, text, margin.left + (width * k) / 4, size - margin.bottom + 14, k === 0 ? "left" : k === 4 ? "right" : "center"));
  words(pen, p.sector_axis, margin.left + width / 2, size - 5, "center");
  return `${captions[layer]}; downwards: ${p.ring_axis}`;
}

/** Draws it and returns its caption. */
export function drawPoints(canvas: HTMLCanvasElement, picture: PointPicture, layer: string): string {
  const pen = canvas.getContext("2d")!;
  if (picture.kind === "line") return drawBars(pen, canvas.width, picture);
  if (picture.kind === "map") return drawMap(pen, canvas.width, picture, layer);
  frame(pen, canvas.width);
  return "no picture of points with more than two coordinates: the verdicts say where draws and pdf differ";
}
