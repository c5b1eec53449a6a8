// The findings of one cause, one row each: where, how large on an axis that they share, how sure, and what is behind them.
import type {JSX} from 'preact';
import type {Quantity} from '../../api/documents';
import {writeNumber, writeQuantity, writeTick} from '../../format/number';
import {countWord, listWords, symbolOf, writeSentence, writeUnit} from '../../format/words';
import {linear, ticksBetween} from '../../figure/scale';
import {finite} from '../../figure/spec';
import {choose, usePlace} from '../../route';
import {axisOf, causeName, checkKind, columnOf, keyOf, restsOn, type Check, type Finding, type Investigation} from './documents';

const MOST_BAR = 1000;
const WIDTH = 132;

type Axis = (value: number) => number;

// What the intervals of a parameter share, from zero on; null where there is nothing to compare.
function axisFor(quantities: readonly (Quantity | undefined)[]): {x: Axis; ticks: number[]} | null {
  const ends = quantities.flatMap(quantity => [quantity?.value, ...(quantity?.ci95 ?? [])]).filter(finite);
  if (quantities.length < 2 || ends.length === 0) return null;
  const [low, high] = [Math.min(0, ...ends), Math.max(0, ...ends)];
  return {x: linear(low, high, 6, WIDTH - 8), ticks: ticksBetween(low, high, 3)};
}

function Whisker({quantity, x}: {quantity: Quantity | undefined; x: Axis}): JSX.Element {
  const [low, high] = quantity?.ci95 ?? [];
  return <svg width={WIDTH} height="20" aria-hidden="true"><line class="ax" x1={x(0)} x2={x(0)} y1="0" y2="20" />
    {finite(low) && finite(high) && <line x1={x(low)} x2={x(high)} y1="10" y2="10" stroke="var(--ink)" stroke-width="1.5" />}{finite(quantity?.value) && <circle cx={x(quantity.value)} cy="10" r="3.4" fill="var(--ink)" />}</svg>;
}

function Size({quantity}: {quantity: Quantity | undefined}): JSX.Element {
  if (!quantity) return <>–</>;
  const written = writeQuantity(quantity);
  return <><b>{written.value}</b> <span class="u">{writeUnit(quantity.unit)}</span> <span class="ci">{written.interval}</span></>;
}

// The checks that a finding rests on; a click lights their squares.
function Because({checks, id}: {checks: readonly Check[]; id: string}): JSX.Element | null {
  const lit = usePlace().query.get('lit') === id;
  if (checks.length === 0) return null;
  const kinds = [...new Set(checks.map(check => `${columnOf(check.channel)} ${checkKind(check)}`))];
  return <p>Rests on {checks.length === 1 ? 'the check' : `${countWord(checks.length)} checks:`} {listWords(kinds)}. <button type="button" class="link" aria-pressed={lit} onClick={() => choose({lit: lit ? null : id})}>{lit ? 'Do not mark them' : 'Mark them'}</button></p>;
}

export function Findings({list, found, names, total}: {list: readonly Finding[]; found: Investigation; names: ReadonlyMap<string, string>; total: number}): JSX.Element {
  const {query} = usePlace();
  const parameters = [...new Set(list.flatMap(finding => Object.keys(finding.parameters)))];
  const size = parameters[0] ?? '';
  const axis = axisFor(list.map(finding => finding.parameters[size]));
  const columns = 4 + parameters.length + (axis ? 1 : 0);
  return <div class="scroll"><table class="stacked findings"><thead><tr><th scope="col">axis</th>{parameters.map(name => <th key={name} scope="col">{symbolOf(name)}</th>)}{axis && <th scope="col" class="desk-only"><span class="visually-hidden">{symbolOf(size)} on a shared axis</span></th>}<th scope="col">recordings</th><th scope="col">evidence, over 6 identifies</th><th scope="col" class="n">held-out gain, 10⁻³ nats a sample</th></tr></thead>
    {list.map(finding => {
      const id = keyOf(finding, found.findings);
      const open = query.get('finding') === id;
      const recordings = [...new Set(finding.channels.map(channel => /^(rec_[0-9A-Z]{26})\//.exec(channel)?.[1]).filter((one): one is string => Boolean(one)))];
      const score = finding.score ?? 0;
      const rivals = finding.rivals ?? [];
      return <tbody key={id} class={`finding ${finding.status}`} aria-current={open ? 'true' : undefined}>
        <tr><th scope="row">{[...new Set(finding.channels.map(axisOf))].join(', ')}</th>
          {parameters.map(name => <td key={name} data-label={symbolOf(name)}><Size quantity={finding.parameters[name]} /></td>)}
          {axis && <td class="desk-only"><Whisker quantity={finding.parameters[size]} x={axis.x} /></td>}
          <td class="sec">{recordings.length === 0 || recordings.length === total ? `all ${total || ''}` : recordings.length === 1 ? `${names.get(recordings[0]!) ?? 'one'} only` : `${recordings.length} of ${total}`}</td>
          <td class="nowrap" data-label="evidence"><svg width="90" height="8" aria-hidden="true"><rect x="0" y="1" width={Math.min(90, Math.log1p(Math.max(score, 0)) / Math.log1p(MOST_BAR) * 90)} height="5" fill="var(--model)" /></svg> {writeNumber(score, 3)}</td>
          <td class="n" data-label="held-out gain, 10⁻³ nats a sample">{finding.gain.heldout && finite(finding.gain.log_score_per_sample) ? writeNumber(finding.gain.log_score_per_sample * 1000, 2) : '–'}</td></tr>
        <tr class="behind"><td colSpan={columns}><details open={open}><summary class="sec" onClick={event => { event.preventDefault(); choose({finding: open ? null : id}); }}>{finding.status === 'ambiguous' && finding.alternatives.length > 0 ? `cannot be told from ${listWords(finding.alternatives.map(causeName))}` : 'explanation'}</summary>
          <p>{writeSentence(finding.explanation)}</p>
          {finding.equation && <p class="equation">{finding.equation}</p>}
          <Because checks={restsOn(finding, found.checks)} id={id} />
          {rivals.length > 0 && <p class="sec">Rivals and their evidence, {writeNumber(score, 3)} for this: {rivals.map(rival => `${rival.title} ${rival.score === null ? '–' : writeNumber(rival.score, 3)}`).join(', ')}.</p>}
          {finding.next_measurement && <p class="sec">Next: {finding.next_measurement}</p>}
          {finding.gain.heldout && finding.gain.of_the_file && <p class="u">The held-out gain is of the digits and rows of the file.</p>}</details></td></tr>
      </tbody>;
    })}
    {axis && <tbody class="desk-only" aria-hidden="true"><tr class="axis"><td colSpan={1 + parameters.length} /><td><svg width={WIDTH} height="16">{axis.ticks.map(tick => <text key={tick} class="s" x={axis.x(tick)} y="12" text-anchor="middle">{writeTick(tick)}</text>)}</svg></td><td colSpan={3} /></tr></tbody>}
  </table></div>;
}
