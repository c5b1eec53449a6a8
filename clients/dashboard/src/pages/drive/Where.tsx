// The drive with the ends of its outages, north up: each with the error, and the ellipse that the filter believes in around where it believes to be.
import type {JSX} from 'preact';
import {barLength} from '../../format/bar';
import {writeTick} from '../../format/number';
import type {Duration, Measured} from './documents';

const SIZE = 420;
const PAD = 34;
// By the share of errors that the ellipse through it holds: -2 ln(1 - share) of NEES.
const CLASSES: readonly (readonly [string, number, string])[] = [['in 50 %', 1.386, 'var(--good)'], ['more in 95 %', 5.991, 'var(--model)'], ['outside', Infinity, 'var(--robust)']];

export function Where({of, path}: {of: Duration; path: Measured['path']}): JSX.Element {
  const north = of.outages.map(outage => outage.map_m[0] ?? 0);
  const east = of.outages.map(outage => outage.map_m[1] ?? 0);
  const [e, n] = [[...east, ...path?.east_m ?? []], [...north, ...path?.north_m ?? []]];
  const [e0, e1, n0, n1] = [Math.min(...e), Math.max(...e), Math.min(...n), Math.max(...n)];
  const scale = (SIZE - 2 * PAD) / Math.max(e1 - e0, n1 - n0, 1);
  const height = Math.max(160, (n1 - n0) * scale + 2 * PAD + 26);
  const x = (value: number): number => SIZE / 2 + (value - (e0 + e1) / 2) * scale;
  const y = (value: number): number => (height - 26) / 2 - (value - (n0 + n1) / 2) * scale;
  const bar = barLength(scale, 110);
  const kind = (nees: number | null): number => CLASSES.findIndex(([, most]) => (nees ?? Infinity) <= most);
  const counts = CLASSES.map((_, k) => of.outages.filter(outage => kind(outage.nees) === k).length);
  return <svg viewBox={`0 0 ${SIZE} ${height}`} width="100%" class="where" role="img" aria-label={`Where ${of.n} outages of ${of.duration_s} s ended; ${counts[2]} errors lie outside the filter’s 95 % ellipse.`}>
    {path && <polyline points={path.east_m.map((each, i) => `${x(each).toFixed(1)},${y(path.north_m[i]!).toFixed(1)}`).join(' ')} fill="none" stroke="var(--rule)" />}
    {of.outages.map((outage, i) => {
      const colour = CLASSES[kind(outage.nees)]![2];
      const [nn, ne, ee] = outage.covariance_m2 as [number, number, number];
      const middle = (nn + ee) / 2;
      const more = Math.hypot((nn - ee) / 2, ne);
      const [cx, cy] = [x(east[i]! + outage.east_m), y(north[i]! + outage.north_m)];
      const radius = (square: number): number => Math.sqrt(5.991 * Math.max(square, 0)) * scale;
      return <g key={i} stroke={colour} fill="none"><circle cx={x(east[i]!)} cy={y(north[i]!)} r="2" fill={colour} /><path d={`M${x(east[i]!)},${y(north[i]!)}L${cx},${cy}`} />
        <ellipse cx={cx} cy={cy} rx={radius(middle + more)} ry={radius(middle - more)} transform={`rotate(${-Math.atan2(2 * ne, ee - nn) * 90 / Math.PI} ${cx} ${cy})`} /></g>;
    })}
    <path class="ax" d={`M20,${height - 14}v-5v5h${bar * scale}v-5`} /><text x={20 + bar * scale / 2} y={height - 22} text-anchor="middle">{writeTick(bar)} m</text>
    {CLASSES.map(([name,, colour], k) => <text key={name} x={[140, 210, 318][k]} y={height - 16} style={{fill: colour}}>{counts[k]} {name}</text>)}<text x={SIZE - 10} y={height - 16} text-anchor="end">N ↑</text>
  </svg>;
}
