// Where the outages lie: one disc each, as large as its error, north up.
import type {JSX} from 'preact';
import {writeNumber, writeTick} from '../../format/number';
import {errorOf, type Duration} from './documents';

const SIZE = 420;
const PAD = 34;
const LARGEST = 15;  // pixels of the worst outage

export function Where({of}: {of: Duration}): JSX.Element {
  const north = of.outages.map(outage => outage.map_m[0] ?? 0);
  const east = of.outages.map(outage => outage.map_m[1] ?? 0);
  const [e0, e1, n0, n1] = [Math.min(...east), Math.max(...east), Math.min(...north), Math.max(...north)];
  const scale = (SIZE - 2 * PAD) / Math.max(e1 - e0, n1 - n0, 1);
  const height = Math.max(160, (n1 - n0) * scale + 2 * PAD + 26);
  const x = (value: number): number => SIZE / 2 + (value - (e0 + e1) / 2) * scale;
  const y = (value: number): number => (height - 26) / 2 - (value - (n0 + n1) / 2) * scale;
  const rough = 110 / scale;
  const power = 10 ** Math.floor(Math.log10(rough));
  const bar = [5, 2, 1].map(digit => digit * power).find(length => length <= rough) ?? power;
  const worst = Math.max(...of.outages.map(errorOf), 1e-9);
  return <svg viewBox={`0 0 ${SIZE} ${height}`} width="100%" class="where" role="img" aria-label={`${of.outages.length} outages of ${of.duration_s} s where they began, each a disc as large as its error; the worst is ${writeNumber(worst)} m.`}>
    {of.outages.map((outage, i) => { const radius = 1.5 + LARGEST * Math.sqrt(errorOf(outage) / worst); return <g key={i}>
      <circle cx={x(east[i]!)} cy={y(north[i]!)} r={radius} fill="var(--ink2)" opacity="0.22" /><circle cx={x(east[i]!)} cy={y(north[i]!)} r="1.7" fill="var(--ink)" /></g>; })}
    <path class="ax" d={`M20,${height - 14}v-5v5h${bar * scale}v-5`} /><text x={20 + bar * scale / 2} y={height - 22} text-anchor="middle">{writeTick(bar)} m</text>
    <circle cx={SIZE - 132} cy={height - 20} r={1.5 + LARGEST} fill="var(--ink2)" opacity="0.22" /><text x={SIZE - 110} y={height - 16}>{writeNumber(worst, 2)} m</text><text x={SIZE - 22} y={height - 16} text-anchor="end">N ↑</text>
  </svg>;
}
