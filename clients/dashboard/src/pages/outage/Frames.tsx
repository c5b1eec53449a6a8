// Whether the ellipse that a filter believes in holds what happened: runs as dots, its own 95 % solid, what happened dashed.
import type {JSX} from 'preact';
import {writeNumber, writeShare} from '../../format/number';
import {at95, type Ellipse, type Filter} from './documents';

const SIZE = 320;
const HEAD = 34;

function EllipseMark({ellipse, scale, colour, dash}: {ellipse: Ellipse | undefined; scale: number; colour: string; dash?: string}): JSX.Element | null {
  if (!ellipse) return null;
  return <ellipse cx={SIZE / 2} cy={SIZE / 2} rx={ellipse.semi_major_m * scale} ry={ellipse.semi_minor_m * scale} transform={`rotate(${ellipse.major_axis_azimuth_deg - 90} ${SIZE / 2} ${SIZE / 2})`} fill="none" stroke={colour} stroke-width={dash ? 1.2 : 2} {...(dash ? {'stroke-dasharray': dash} : {})} />;
}

export function Frame({filter, outage, reach, colour}: {filter: Filter; outage: number; reach: number; colour: string}): JSX.Element {
  const one = filter.outages[outage]!;
  const scale = (SIZE / 2 - 14) / reach;
  const rings = Array.from({length: Math.floor(reach / 10)}, (_, i) => (i + 1) * 10);
  return <div>
    <svg viewBox={`0 ${-HEAD} ${SIZE} ${SIZE + HEAD}`} width="100%" role="img" aria-label={`${filter.name} at the end of outage ${one.index}: ${one.errors.north_m.length} runs; the filter's own 95 % ellipse holds ${writeShare(one.coverage95)} of them, NEES ${writeNumber(one.nees, 2)}.`}>
      <text class="b" x="0" y={-HEAD + 13}>{filter.name}</text><text class="s" x="0" y={-HEAD + 29}>NEES {writeNumber(one.nees, 2)}, holds {writeShare(one.coverage95)}</text>
      {rings.map(ring => <g key={ring}><circle class="gr" cx={SIZE / 2} cy={SIZE / 2} r={ring * scale} /><text class="s h" x={SIZE / 2 + ring * scale * 0.71 + 3} y={SIZE / 2 - ring * scale * 0.71 - 2}>{ring} m</text></g>)}
      <path class="gr" d={`M${SIZE / 2},8V${SIZE - 8}M8,${SIZE / 2}H${SIZE - 8}`} />
      {one.errors.north_m.map((north, i) => { const east = one.errors.east_m[i]; return north === null || east === null || east === undefined ? null : <circle key={i} cx={SIZE / 2 + east * scale} cy={SIZE / 2 - north * scale} r="1.7" fill="var(--ink2)" opacity="0.75" />; })}
      <EllipseMark ellipse={at95(one.actual.ellipses)} scale={scale} colour="var(--ink)" dash="4 3" />
      <EllipseMark ellipse={at95(one.predicted.ellipses)} scale={scale} colour={colour} />
    </svg>
  </div>;
}

// How far the frames of both filters reach, in whole tens of metres.
export function reachOf(filters: readonly Filter[], outage: number): number {
  const far = filters.flatMap(filter => {
    const one = filter.outages[outage]!;
    return [...one.errors.north_m.map((north, i) => Math.hypot(north ?? 0, one.errors.east_m[i] ?? 0)), at95(one.actual.ellipses)?.semi_major_m ?? 0];
  }).sort((a, b) => a - b);
  return Math.max(10, Math.ceil((far[Math.floor(far.length * 0.99)] ?? 10) * 1.08 / 5) * 5);
}
