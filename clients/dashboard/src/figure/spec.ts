// What a figure draws: data in, no page knowledge.

export type Numbers = readonly (number | null)[];
export type Mark = 'dot' | 'open' | 'diamond' | 'square' | 'triangle';

export interface Series {
  id: string;
  name: string;
  detail?: string;       // second line of its key
  x: readonly number[];
  y: Numbers;
  low?: Numbers;
  high?: Numbers;
  mark?: Mark;           // points are drawn
  line?: boolean;        // joined
  bars?: boolean;        // from the foot of the plot, as wide as the points are apart
  colour: string;        // a token: var(--model)
  colours?: readonly string[];  // of each point, where they differ
  band?: string;         // fill between low and high, a token
  width?: number;
  dash?: string;
  hidden?: boolean;      // in the table, not drawn
  noKey?: boolean;
}

export interface Axis {
  scale: 'log' | 'linear';
  name: string;          // with its unit: 'averaging time τ, s'
  domain?: readonly [number, number];
  ticks?: readonly number[];
  write?: (value: number) => string;
}

export interface Note {
  x: number;
  y: number;
  text: string;
  sub?: string;
  anchor?: 'start' | 'middle' | 'end';
  colour?: string;
  drop?: boolean;        // a dotted line down to the axis, with the text at its foot
  line?: number;         // a rule at this height over the right half
  ring?: boolean;
}

// A stretch of the x axis that is not like the rest: shaded over the whole height, hatched, a bar along the top or the foot, a mark or an
// open diamond above it, or a line where it begins.
export interface Zone { from: number; to: number; style: 'shade' | 'hatch' | 'top' | 'foot' | 'mark' | 'diamond' | 'edge'; colour: string; text?: string }

export interface Guide { slope: number; text: string }

export interface Plot {
  id: string;
  x: Axis;
  y: Axis;
  series: readonly Series[];
  notes?: readonly Note[];
  guides?: readonly Guide[];
  zones?: readonly Zone[];
  equalDecades?: boolean;
  height?: number;       // of the drawing area; not for equal decades
  rules?: readonly number[];  // horizontal lines
  hideX?: boolean;       // shares the axis of the plot above
}

export const finite = (x: number | null | undefined): x is number => typeof x === 'number' && Number.isFinite(x);

// The index whose x is nearest, on the axis' own scale.
export function nearest(xs: readonly number[], x: number, log: boolean): number {
  let best = -1;
  let least = Infinity;
  xs.forEach((each, i) => {
    const distance = log ? Math.abs(Math.log(each / x)) : Math.abs(each - x);
    if (distance < least) { least = distance; best = i; }
  });
  return best;
}

// The value of a curve between its points; log-log where the axis is.
export function valueAt(series: Series, x: number, log: boolean): number | null {
  const i = series.x.findIndex(each => each >= x * (1 - 1e-9));
  if (i < 0) return null;
  const x1 = series.x[i];
  const y1 = series.y[i];
  if (!finite(y1) || x1 === undefined) return null;
  if (Math.abs(x1 - x) <= 1e-9 * Math.abs(x) || i === 0) return Math.abs(x1 - x) <= 1e-6 * Math.abs(x) ? y1 : null;
  const x0 = series.x[i - 1];
  const y0 = series.y[i - 1];
  if (!finite(y0) || x0 === undefined) return null;
  if (!log) return y0 + (y1 - y0) * (x - x0) / (x1 - x0);
  return Math.exp(Math.log(y0) + Math.log(y1 / y0) * Math.log(x / x0) / Math.log(x1 / x0));
}
