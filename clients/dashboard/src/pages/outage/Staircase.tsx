// Where the gain comes from: a staircase from one filter to the next, each step a paired difference with its interval.
import type {JSX} from 'preact';
import {writeNumber, writeQuantity, writeTick} from '../../format/number';
import {useWidth} from '../../figure/Figure';
import {linear, ticksBetween} from '../../figure/scale';
import type {Evaluation, Filter, Pair} from './documents';

const STEP = 28;
const NAMES = 190;
const WORDS = 150;  // right of the last step
const LEAST = 560;

export function stepsOf(evaluation: Evaluation): {name: string; pair: Pair}[] {
  const {attribution} = evaluation;
  return attribution ? [{name: 'low-frequency noise in the filter', pair: attribution.low_frequency_noise}, {name: 'Gauss-Markov states', pair: attribution.gauss_markov_states}, {name: 'following the rate', pair: attribution.switching}] : [];
}

export function Staircase({evaluation, from}: {evaluation: Evaluation; from: Filter}): JSX.Element {
  const [box, room] = useWidth();
  const width = Math.max(room, LEAST);
  const start = from.mean_error_m.value ?? 0;
  let level = start;
  const stairs = stepsOf(evaluation).map(({name, pair}) => { const before = level; level += pair.difference_m.value ?? 0; return {name, pair, before, after: level}; });
  const ends = [start, ...stairs.map(each => each.after)];
  const most = Math.max(...ends) + 1e-9;
  const x = linear(Math.min(...ends), most, NAMES + 20, width - WORDS);
  const height = STEP * (stairs.length + 1) + 24;
  const bottom = height - 20;
  return <div class="scroll" ref={box} tabIndex={0} role="region" aria-label="Staircase"><svg viewBox={`0 0 ${width} ${height}`} width={width} height={height} role="img" aria-label={`From ${writeNumber(start)} m with ${from.name}: ${stairs.map(each => `${each.name} ${writeQuantity(each.pair.difference_m).value} m`).join(', ')}.`}>
    {ticksBetween(x.invert(NAMES), most, 5).map(tick => <g key={tick}><line class="gr" x1={x(tick)} x2={x(tick)} y1="4" y2={bottom} /><text class="s" x={x(tick)} y={height - 5} text-anchor="middle">{writeTick(tick)} m</text></g>)}
    <text class="b" x="0" y="20" style={{fill: 'var(--robust)'}}>{from.name}</text><circle cx={x(start)} cy="16" r="4.5" fill="var(--robust)" /><text class="h" x={x(start) + 10} y="20">{writeQuantity(from.mean_error_m).value} m</text>
    {stairs.map((each, i) => { const y = STEP * (i + 1) + 16; const written = writeQuantity(each.pair.difference_m); return <g key={each.name}>
      <line class="ax" x1={x(each.before)} x2={x(each.before)} y1={y - STEP} y2={y} /><text class="t" x="0" y={y + 4}>{each.name}</text>
      <line x1={x(each.before)} x2={x(each.after)} y1={y} y2={y} stroke="var(--ink)" stroke-width="5" /><text class="h" x={Math.max(x(each.before), x(each.after)) + 10} y={y + 4}>{written.value} m {written.interval}</text></g>; })}
  </svg></div>;
}
