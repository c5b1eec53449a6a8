// Points, curves and bands of a plot; the meaning is in mark and dash, colour repeats it.
import type {JSX} from 'preact';
import type {Area} from './layout';
import {MarkAt} from './MarkAt';
import {finite, type Series} from './spec';

const round = (x: number): number => Math.round(x * 10) / 10;

function visible(series: Series, place: Area): number[] {
  const [low, high] = place.x.domain;
  const positive = place.plot.y.scale === 'log';
  const indices: number[] = [];
  series.x.forEach((x, i) => {
    const y = series.y[i];
    if (finite(y) && (!positive || y > 0) && x >= low * (1 - 1e-12) - 1e-12 && x <= high * (1 + 1e-12) + 1e-12) indices.push(i);
  });
  return indices;
}

// A line through the points that are there, interrupted where one is not.
function through(indices: readonly number[], isThere: (i: number) => boolean, x: (i: number) => number, y: (i: number) => number): string {
  return indices.map((i, nth) => isThere(i) ? `${nth > 0 && isThere(indices[nth - 1]!) ? 'L' : 'M'}${x(i)},${y(i)}` : '').join('');
}

export function Band({series, place}: {series: Series; place: Area}): JSX.Element | null {
  if (!series.band || !series.low || !series.high) return null;
  const inside = new Set(visible(series, place).filter(i => finite(series.high?.[i])));
  const log = place.plot.y.scale === 'log';
  const x = (i: number): number => round(place.x(series.x[i]!));
  const low = (i: number): number => { const end = series.low![i]; return round(finite(end) && (!log || end > 0) ? place.y(end) : place.bottom); };
  const stretches = series.x.reduce<number[][]>((found, _, i) => {
    if (inside.has(i)) found[found.length - 1]!.push(i);
    else if (!finite(series.y[i])) found.push([]);
    return found;
  }, [[]]);
  // Out along the upper ends and back along the lower ones.
  const path = stretches.map(one => one.length > 0 ? `${through(one, () => true, x, i => round(place.y(series.high![i]!)))}${[...one].reverse().map(i => `L${x(i)},${low(i)}`).join('')}Z` : '').join('');
  return <path d={path} fill={series.band} stroke="none" />;
}

export function Curve({series, place}: {series: Series; place: Area}): JSX.Element | null {
  if (!series.line) return null;
  const ok = new Set(visible(series, place));
  const path = through(series.x.map((_, i) => i), i => ok.has(i), i => round(place.x(series.x[i]!)), i => round(place.y(series.y[i]!)));
  return <path d={path} fill="none" stroke={series.colour} stroke-width={series.width ?? 1.3} stroke-linejoin="round" {...(series.dash ? {'stroke-dasharray': series.dash} : {})} />;
}

export function Points({series, place}: {series: Series; place: Area}): JSX.Element | null {
  const {mark} = series;
  if (!mark) return null;
  const log = place.plot.y.scale === 'log';
  return <g>{visible(series, place).map(i => {
    const x = round(place.x(series.x[i]!));
    const low = series.low?.[i];
    const high = series.high?.[i];
    const to = (v: number | null | undefined, open: number): number => round(finite(v) && (!log || v > 0) ? place.y(v) : open);
    const colour = series.colours?.[i] ?? series.colour;
    return <g key={i}>
      {(finite(low) || finite(high)) && <line x1={x} x2={x} y1={to(low, place.bottom)} y2={to(high, place.top)} stroke={colour} stroke-width="1.3" />}
      <MarkAt mark={mark} x={x} y={round(place.y(series.y[i]!))} colour={colour} />
    </g>;
  })}</g>;
}

export function Bars({series, place}: {series: Series; place: Area}): JSX.Element | null {
  if (!series.bars) return null;
  const [first = 0, second = 1] = series.x;
  const width = Math.max(0.5, Math.abs(place.x(second) - place.x(first)) - 0.6);
  const path = visible(series, place).map(i => { const top = round(Math.min(place.y(series.y[i]!), place.bottom)); return `M${round(place.x(series.x[i]!) - width / 2)},${place.bottom}V${top}h${round(width)}V${place.bottom}Z`; }).join('');
  return <path d={path} fill={series.colour} stroke="none" />;
}

// The sample of a series in a key, 22 px wide.
export function Sample({series, x, y}: {series: Series; x: number; y: number}): JSX.Element {
  return <g>
    {series.bars && <rect x={x + 4} width="14" y={y - 5} height="10" fill={series.colour} />}
    {series.line && <line x1={x} x2={x + 22} y1={y} y2={y} stroke={series.colour} stroke-width={series.width ?? 1.3} {...(series.dash ? {'stroke-dasharray': series.dash} : {})} />}
    {series.mark && <>
      {series.low && <line x1={x + 11} x2={x + 11} y1={y - 7} y2={y + 7} stroke={series.colour} stroke-width="1.3" />}
      <MarkAt mark={series.mark} x={x + 11} y={y} colour={series.colour} />
    </>}
  </g>;
}
