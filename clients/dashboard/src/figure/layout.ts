// Where things go: scales, margins and ticks of a column of plots that share their x axis.
import {decadeTicks, linear, logarithmic, ticksBetween, type Mapping} from './scale';
import {finite, type Axis, type Numbers, type Plot, type Series} from './spec';

export interface Scale extends Mapping { ticks: number[]; minor: number[]; domain: [number, number] }

export interface Area {
  plot: Plot;
  x: Scale;
  y: Scale;
  left: number; right: number; top: number; bottom: number;
  foot: number;          // lowest pixel that belongs to it
}

export interface Layout { width: number; height: number; areas: Area[]; keyBelow: boolean; keyLeft: number; keyWidth: number }

const LEFT = 58;
const KEY = 152;
const NARROW = 600;
const LEAST_EQUAL = 240;
const MOST_EQUAL = 900;
const KEY_LINE = 18;
const KEY_SAMPLE = 34;  // the stroke before a name
const KEY_LETTER = 7.2;

function extent(lists: Numbers[], log: boolean): [number, number] {
  let low = Infinity;
  let high = -Infinity;
  for (const list of lists) {
    for (const value of list) {
      if (!finite(value) || (log && value <= 0)) continue;
      low = Math.min(low, value);
      high = Math.max(high, value);
    }
  }
  if (!(low <= high)) return log ? [0.1, 10] : [0, 1];
  if (low === high) return log ? [low / 2, high * 2] : [low - 1, high + 1];
  return [low, high];
}

function padded([low, high]: [number, number], log: boolean, share: number): [number, number] {
  if (log) {
    const more = (high / low) ** share;
    return [low / more, high * more];
  }
  const more = (high - low) * share;
  return [low - more, high + more];
}

function logTicks([low, high]: [number, number]): {ticks: number[]; minor: number[]} {
  const decades = Math.log10(high / low);
  const every = decades > 9 ? 2 : 1;
  const ticks = decadeTicks(low, high, decades < 1.3 ? [1, 2, 3, 5] : decades < 2.2 ? [1, 2, 5] : [1]).filter(tick => Math.floor(Math.log10(tick) + 1e-9) % every === 0);
  return {ticks, minor: decadeTicks(low, high, [1, 2, 3, 4, 5, 6, 7, 8, 9]).filter(tick => !ticks.includes(tick))};
}

export function makeScale(axis: Axis, domain: [number, number], from: number, to: number): Scale {
  const isLog = axis.scale === 'log';
  const ticks = axis.ticks ? {ticks: [...axis.ticks], minor: []} : isLog ? logTicks(domain) : {ticks: ticksBetween(...domain, Math.max(2, Math.round(Math.abs(to - from) / (from < to ? 90 : 44)))), minor: []};
  return Object.assign((isLog ? logarithmic : linear)(...domain, from, to), {domain, ...ticks});
}

const drawn = (plot: Plot): readonly Series[] => plot.series.filter(series => !series.hidden);

function domainX(plots: readonly Plot[]): [number, number] {
  const axis = plots[0]!.x;
  if (axis.domain) return [axis.domain[0], axis.domain[1]];
  // Curves follow the points, not the other way round.
  const all = plots.flatMap(plot => drawn(plot));
  const points = all.filter(series => series.mark);
  const range = extent((points.length > 0 ? points : all).map(series => series.x), axis.scale === 'log');
  return padded(range, axis.scale === 'log', 0.03);
}

function domainY(plot: Plot, x: [number, number]): [number, number] {
  if (plot.y.domain) return [plot.y.domain[0], plot.y.domain[1]];
  const log = plot.y.scale === 'log';
  const inside = (series: Series, values: Numbers): Numbers => values.filter((_, i) => { const at = series.x[i]!; return at >= x[0] && at <= x[1]; });
  const points = drawn(plot).filter(series => series.mark);
  const body = extent((points.length > 0 ? points : drawn(plot)).map(series => inside(series, series.y)), log);
  const ends = extent(drawn(plot).flatMap(series => [series.y, series.low ?? [], series.high ?? []].map(values => inside(series, values))), log);
  // The last intervals may reach far: what lies a decade outside the points is cut.
  const range: [number, number] = log ? [Math.max(ends[0], body[0] / 8), Math.min(ends[1], body[1] * 8)] : ends;
  return padded(range, log, 0.05);
}

// `share` of the heights that plots ask for: paper has room for less than a screen.
export function layout(plots: readonly Plot[], width: number, share = 1): Layout {
  const keyed = plots.flatMap(drawn).filter(series => !series.noKey);
  const keys = keyed.length;
  const keyBelow = width < NARROW || keys === 0;
  const keyWidth = Math.max(...keyed.map(series => KEY_SAMPLE + KEY_LETTER * series.name.length), 100);
  const x = domainX(plots);
  const decades = ([low, high]: readonly [number, number]): number => Math.log10(high / low);
  // Decades that are equal and too high for a screen are all smaller: what was measured is never cut.
  const highest = Math.max(0, ...plots.filter(plot => plot.equalDecades).map(plot => decades(domainY(plot, x))));
  const right = Math.min(keyBelow ? width - 8 : width - KEY, LEFT + (highest > 0 ? MOST_EQUAL / highest * decades(x) : Infinity));
  let top = 0;
  const areas: Area[] = [];
  for (const plot of plots) {
    const y = domainY(plot, x);
    let height = share * (plot.height ?? 220);
    if (plot.equalDecades) {
      const perDecade = (right - LEFT) / decades(x);
      height = perDecade * decades(y);
      const wanted = Math.max(height, share * LEAST_EQUAL);
      const more = 10 ** ((wanted - height) / perDecade / 2);
      y[0] /= more;
      y[1] *= more;
      height = wanted;
    }
    const areaTop = top + (plot.y.name ? 32 : 10);
    const areaBottom = areaTop + height;
    const foot = areaBottom + (plot.hideX ? 12 : plot.x.name ? 44 : 26);
    areas.push({plot, x: makeScale(plot.x, x, LEFT, right), y: makeScale(plot.y, y, areaBottom, areaTop), left: LEFT, right, top: areaTop, bottom: areaBottom, foot});
    top = foot;
  }
  const columns = Math.max(1, Math.floor(width / keyWidth));
  return {width, height: top + (keyBelow && keys > 0 ? Math.ceil(keys / columns) * KEY_LINE + 6 : 0), areas, keyBelow, keyLeft: keyBelow ? width - KEY + 14 : right + 14, keyWidth};
}
