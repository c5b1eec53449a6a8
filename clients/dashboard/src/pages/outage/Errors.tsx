// Mean horizontal error of every filter, over all outages and at each of them, on one scale.
import type {JSX} from 'preact';
import {writeQuantity, writeTick} from '../../format/number';
import {useWidth} from '../../figure/Figure';
import {ticksBetween} from '../../figure/scale';
import type {Filter} from './documents';
import type {Quantity} from '../../api/documents';

export const ROW = 36;
const NAMES = 132;
const HEAD = 22;
const GAP = 14;
const LEAST = 660;     // of the mean and its outages side by side
const LEAST_ALONE = 300;
const MOST_TICKS = 10;
const LABEL = 34;  // of the mean's value, behind its whisker

type Erring = Pick<Filter, 'name' | 'mean_error_m' | 'outages'>;

// A running evaluation knows the mean over all outages alone.
export function Errors({filters, colours}: {filters: readonly Erring[]; colours: readonly string[]}): JSX.Element {
  const [box, room] = useWidth();
  const outages = filters[0]?.outages ?? [];
  const width = Math.max(room, outages.length > 0 ? LEAST : LEAST_ALONE);
  const facets: {title: string; pick: (filter: Erring) => Quantity}[] = [{title: outages.length > 0 ? `mean of ${outages.length}` : 'mean of all outages', pick: filter => filter.mean_error_m}, ...outages.map((one, i) => ({title: `outage ${one.index}`, pick: (filter: Erring) => filter.outages[i]!.error_m}))];
  const most = Math.max(...filters.flatMap(filter => facets.map(({pick}) => pick(filter).ci95?.[1] ?? pick(filter).value ?? 0))) * 1.05;
  const wide = (width - NAMES - LABEL) / facets.length - GAP;
  const height = HEAD + filters.length * ROW + 20;
  const bottom = height - 18;
  const ticks = ticksBetween(0, most, Math.min(MOST_TICKS, Math.max(1, Math.floor(wide / 60))));
  return <div class="scroll" ref={box} tabIndex={0} role="region" aria-label="Errors by filter"><svg viewBox={`0 0 ${width} ${height}`} width={width} height={height} role="img"
    aria-label={`Mean horizontal error: ${filters.map(filter => `${filter.name} ${writeQuantity(filter.mean_error_m).value} m ${writeQuantity(filter.mean_error_m).interval}`).join('; ')}.`}>
    {filters.map((filter, i) => <text key={filter.name} class="t" x="0" y={HEAD + i * ROW + ROW / 2 + 4} style={colours[i] === 'var(--measured)' ? undefined : {fill: colours[i]}}>{filter.name}</text>)}
    {facets.map(({title, pick}, f) => {
      const left = NAMES + f * (wide + GAP) + (f > 0 ? LABEL : 0);
      const x = (value: number): number => left + value / most * wide;
      return <g key={title}><text class="b" x={left} y="12">{title}</text>
        {ticks.map(tick => <g key={tick}><line class={tick === 0 ? 'ax' : 'gr'} x1={x(tick)} x2={x(tick)} y1={HEAD} y2={bottom} /><text class="s" x={x(tick)} y={height - 5} text-anchor={tick === 0 ? 'start' : 'middle'}>{tick === 0 ? '0 m' : writeTick(tick)}</text></g>)}
        {filters.map((filter, i) => { const value = pick(filter); const [low, high] = value.ci95 ?? []; const y = HEAD + i * ROW + ROW / 2; return <g key={filter.name}>
          {low !== null && low !== undefined && high !== null && high !== undefined && <line x1={x(Math.max(0, low))} x2={x(high)} y1={y} y2={y} stroke={colours[i]} stroke-width="1.6" />}
          <circle cx={x(value.value ?? 0)} cy={y} r="4" fill={colours[i]} />{f === 0 && <text class="h" x={x(high ?? value.value ?? 0) + 7} y={y + 4}>{writeQuantity(value).value}</text>}</g>; })}
      </g>;
    })}
  </svg></div>;
}
