// Does the filter know how far off it is: NEES on a logarithmic scale, 2 for two horizontal coordinates, and the share its ellipse holds.
import type {JSX} from 'preact';
import {writeNumber, writeShare} from '../../format/number';
import {useWidth} from '../../figure/Figure';
import type {Filter} from './documents';
import {ROW} from './Errors';

const HONEST = 2;
const NAMES = 132;
const HOLDS = 52;
const HEAD = 16;

export function Nees({filters, colours}: {filters: readonly Filter[]; colours: readonly string[]}): JSX.Element {
  const [box, room] = useWidth();
  const width = Math.max(room, 240);
  const values = filters.flatMap(filter => [filter.nees, ...filter.outages.map(one => one.nees)]);
  const low = Math.min(1, ...values) / 1.1;
  const high = Math.max(4, ...values) * 1.1;
  const x = (value: number): number => NAMES + 6 + Math.log(Math.max(value, low) / low) / Math.log(high / low) * (width - NAMES - HOLDS - 12);
  const ticks = [1, 2, 5, 10, 20, 50, 100, 200, 500, 1000, 2000, 5000].filter(tick => tick >= low && tick <= high);
  const height = HEAD + filters.length * ROW + 20;
  return <div ref={box}><svg viewBox={`0 0 ${width} ${height}`} width={width} height={height} role="img" aria-label={`NEES, 2 is honest: ${filters.map(filter => `${filter.name} ${writeNumber(filter.nees, 2)}, its ellipse holds ${writeShare(filter.coverage95)}`).join('; ')}.`}>
    <text class="s" x={width} y="10" text-anchor="end">holds</text>
    {ticks.map(tick => <g key={tick}><line class={tick === HONEST ? 'ax' : 'gr'} x1={x(tick)} x2={x(tick)} y1={HEAD} y2={height - 18} /><text class="s" x={x(tick)} y={height - 5} text-anchor="middle">{tick}</text></g>)}
    {filters.map((filter, i) => { const y = HEAD + i * ROW + ROW / 2; const [a, b] = filter.nees_ci95; return <g key={filter.name}>
      <text class="t" x="0" y={y + 4} style={colours[i] === 'var(--measured)' ? undefined : {fill: colours[i]}}>{filter.name}</text>
      {filter.outages.map(one => <circle key={one.index} cx={x(one.nees)} cy={y} r="3" fill="var(--surface)" stroke={colours[i]} stroke-width="1.2" />)}
      {a !== null && a !== undefined && b && <line x1={x(a)} x2={x(Math.min(b, high))} y1={y} y2={y} stroke={colours[i]} stroke-width="1.8" />}<circle cx={x(filter.nees)} cy={y} r="4" fill={colours[i]} />
      <text x={width} y={y + 4} text-anchor="end">{writeShare(filter.coverage95)}</text></g>; })}
  </svg></div>;
}
