// Recordings side by side: deviations over each other, their ratio to the first, parameters with differences.
import type {JSX} from 'preact';
import {useMemo, useState} from 'preact/hooks';
import {useRead} from '../api/client';
import type {Channel, Characterisation, Device, List, Quantity, Recording} from '../api/documents';
import {difference, known, ratio} from '../format/interval';
import {writeQuantity} from '../format/number';
import {factorBetween, unitsFor} from '../format/units';
import {conditionName, processName, symbolOf, writeUnit} from '../format/words';
import {defaultReadout, Figure} from '../figure/Figure';
import type {Plot, Series} from '../figure/spec';
import {finite} from '../figure/spec';
import {choose, hover, usePlace} from '../route';
import {Head} from '../shell/Head';
import {Report} from '../shell/Report';
import {Panel, Refusal} from '../shell/states';
import {useTitle} from '../shell/title';

const MOST = 8;
const COLOURS = ['var(--r0)', 'var(--model)', 'var(--robust)', 'var(--c-gm)', 'var(--c-wn)', 'var(--c-rw)', 'var(--c-gm2)', 'var(--c-dr)'];
const MARKS = ['dot', 'square', 'triangle', 'diamond', 'open', 'dot', 'square', 'triangle'] as const;
const DASHES = ['', '7 4', '2 3', '10 3 2 3', '4 4', '1 3', '12 4', '3 6'];

interface Item { key: string; name: string; channel: Channel }

function plotsOf(items: readonly Item[]): Plot[] {
  const unit = unitsFor(items[0]!.channel.unit)[0]!;
  const series = items.map((item, i): Series => {
    const factor = factorBetween(item.channel.unit, unit);
    const times = (values: readonly (number | null | undefined)[]): (number | null)[] => values.map(value => finite(value) ? value * factor : null);
    const {allan} = item.channel;
    return {id: item.key, name: item.name.slice(0, 18), x: allan.tau_s, y: times(allan.deviation), low: times(allan.ci95.map(ends => ends[0])), high: times(allan.ci95.map(ends => ends[1])), mark: MARKS[i]!, line: true, colour: COLOURS[i]!, ...(DASHES[i] ? {dash: DASHES[i]!} : {})};
  });
  const first = series[0]!;
  const at = (one: Series, i: number): {value: number | null; ci95: (number | null)[]} => ({value: one.y[i] ?? null, ci95: [one.low?.[i] ?? null, one.high?.[i] ?? null]});
  const base = new Map(first.x.map((x, i) => [x.toPrecision(6), i] as const));
  // Uncertain is the first one too: its interval is in that of the ratio.
  const ratios = series.slice(1).map((one): Series => {
    const points = one.x.map((x, i) => { const j = base.get(x.toPrecision(6)); const by = j === undefined ? null : first.y[j]; const value = one.y[i]; if (j === undefined || !finite(by) || !finite(value)) return null; const [a, b] = [known(at(one, i)), known(at(first, j))]; return {y: value / by, ends: a && b ? ratio(a, b) : null}; });
    return {...one, id: `${one.id}-ratio`, noKey: true, line: false, y: points.map(point => point?.y ?? null), low: points.map(point => point?.ends?.[0] ?? null), high: points.map(point => point?.ends?.[1] ?? null)};
  });
  const main: Plot = {id: 'deviation', equalDecades: true, x: {scale: 'log', name: ratios.length > 0 ? '' : 'averaging time τ, s'}, y: {scale: 'log', name: `Allan deviation, ${writeUnit(unit)}`}, series};
  return ratios.length > 0 ? [main, {id: 'ratio', height: 130, rules: [1], x: {scale: 'log', name: 'averaging time τ, s'}, y: {scale: 'log', name: `÷ ${first.name}`}, series: ratios}] : [main];
}

function parametersOf(channel: Channel): Map<string, Quantity> {
  const found = new Map<string, Quantity>();
  const seen = new Map<string, number>();
  for (const process of channel.fits[0]?.processes ?? []) {
    const nth = (seen.get(process.process) ?? 0) + 1;
    seen.set(process.process, nth);
    for (const [name, quantity] of Object.entries(process.params)) if (quantity) found.set(`${processName(process.process)}${nth > 1 ? ` ${nth}` : ''} ${symbolOf(name)}`, quantity);
  }
  return found;
}

// A parameter against that of the first item: by how much it differs, and whether that is shown.
function Against({first, quantity}: {first: Quantity; quantity: Quantity}): JSX.Element | null {
  const [a, b] = [known(quantity), known(first)];
  if (quantity.value === null || first.value === null || !a || !b) return <div class="u">no interval to compare by</div>;
  const ends = difference(a, b);
  const times = ratio(a, b);
  const by = writeQuantity({value: a.value - b.value, ci95: ends, unit: ''});
  const factor = times && writeQuantity({value: a.value / b.value, ci95: times, unit: ''});
  return <div class="u">{ends[0] > 0 || ends[1] < 0 ? 'differs by ' : 'no difference shown: '}{a.value > b.value && '+'}{by.value} {by.interval}{factor && <>, {factor.value} {factor.interval} times</>}</div>;
}

function Table({items}: {items: readonly Item[]}): JSX.Element {
  const all = items.map(item => parametersOf(item.channel));
  const names = [...new Set(all.flatMap(one => [...one.keys()]))];
  return <div class="scroll"><table class="stacked"><thead><tr><th scope="col">parameter</th>{items.map(item => <th key={item.key} scope="col">{item.name} <span class="u">{item.channel.fits[0]?.model}</span></th>)}</tr></thead>
    <tbody>{names.map(name => <tr key={name}><th scope="row">{name} <span class="u">{writeUnit(all.map(one => one.get(name)).find(Boolean)?.unit)}</span></th>{all.map((one, i) => { const quantity = one.get(name); const first = all[0]!.get(name); if (!quantity) return <td key={i}>…</td>; const written = writeQuantity(quantity); return <td key={i} data-label={items[i]!.name}><b>{written.value}</b> <span class="ci">{written.interval}</span>{i > 0 && first ? <Against first={first} quantity={quantity} /> : null}</td>; })}</tr>)}</tbody></table></div>;
}

export default function Compare(): JSX.Element {
  const {query} = usePlace();
  useTitle('Compare');
  const wanted = (query.get('with') ?? '').split(',').filter(Boolean).slice(0, MOST);
  const split = wanted.map(text => { const at = text.indexOf(':'); return at < 0 ? [text, ''] as const : [text.slice(0, at), text.slice(at + 1)] as const; });
  const results = Array.from({length: MOST}, (_, i) => useRead<Characterisation>(split[i] ? `/v1/recordings/${split[i]![0]}/characterisation` : null));
  const rows = Array.from({length: MOST}, (_, i) => useRead<Recording>(split[i] ? `/v1/recordings/${split[i]![0]}` : null));
  const recent = useRead<List<Recording>>('/v1/recordings?sort=-created_at&limit=50');
  const devices = useRead<List<Device>>('/v1/devices?limit=500');
  const [adding, setAdding] = useState('');
  const deviceName = (id: string | undefined): string => devices.data?.items.find(one => one.id === id)?.name ?? '';
  const several = new Set(rows.map(row => row.data?.device).filter(Boolean)).size > 1;
  const items = split.flatMap(([, channel], i): Item[] => {
    const result = results[i]!.data;
    const one = result?.channels.find(each => each.result.channel === channel || each.result.axis === channel) ?? result?.channels[0];
    const row = rows[i]!.data;
    const words = [several ? deviceName(row?.device) : '', conditionName(row?.metadata.condition, one?.result.axis), one?.result.axis ?? ''].filter(Boolean).join(' ');
    return one ? [{key: wanted[i]!, name: words, channel: one.result}] : [];
  });
  // Names that are still equal get the recordings' own.
  const said = items.map(item => item.name);
  items.forEach((item, i) => { if (said.indexOf(item.name) !== i || said.lastIndexOf(item.name) !== i) item.name = rows[wanted.indexOf(item.key)]?.data?.metadata.id ?? item.name; });
  const set = (next: string[]): void => choose({with: next.join(',') || null});
  const plots = useMemo(() => items.length > 0 ? plotsOf(items) : [], [items.map(item => item.key + item.name).join()]);
  const problem = results.find((each, i) => i < split.length && each.problem)?.problem;
  const models = [...new Set(items.map(item => item.channel.fits[0]?.model))];
  return <>
    <Head title="Compare" facts={[`up to ${MOST} recordings`]} actions={<Report />} />
    <div class="chips">{wanted.map((key, i) => <span key={key} class="chip">{items.find(item => item.key === key)?.name ?? key}<button type="button" aria-label={`Remove ${items.find(item => item.key === key)?.name ?? key}`} onClick={() => set(wanted.filter((_, j) => j !== i))}>×</button></span>)}
      {wanted.length < MOST && <select class="adds" aria-label="Add a recording" value={adding} onChange={event => { const id = event.currentTarget.value; setAdding(''); if (id) set([...wanted, id]); }}><option value="">Add a recording</option>{(recent.data?.items ?? []).map(one => <option key={one.id} value={one.id}>{deviceName(one.device)}, {one.metadata.id ?? one.id}, {conditionName(one.metadata.condition)}</option>)}</select>}</div>
    {problem && <Panel><Refusal problem={problem} /></Panel>}
    {items.length === 0 && !problem && <p class="verdict">Choose recordings: the same sensor before and after, or two of a kind.</p>}
    {items.length > 0 && <>
      {items.length > 1 && <p class="verdict">{models.length === 1 ? `One structure, ${models[0]}, is ranked first for all of them.` : `Different structures are ranked first: ${models.join(', ')}.`}</p>}
      <Figure name="compare" title="Allan deviation" plots={plots} source="driftlab" describe={`Allan deviations of ${items.map(item => item.name).join(', ')}, and their ratio to the first.`} cursor={Number(query.get('tau')) || null} onCursor={(x, pinned) => { if (pinned) hover({tau: x === null ? null : String(x)}); }} readout={x => <><b>τ {x} s</b>{defaultReadout(plots[0]!, x)}</>} />
      <Panel title="Parameters" sub="of the model ranked first for each; the difference from the first and its 95 % interval"><Table items={items} /></Panel>
    </>}
  </>;
}
