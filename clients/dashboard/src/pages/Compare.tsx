// Recordings, fits, conditions, simulation models and data sheets side by side: deviations over each other, their ratio to the first, parameters with differences.
import type {JSX} from 'preact';
import {useMemo, useState} from 'preact/hooks';
import {useRead} from '../api/client';
import type {Channel, Device, List, Quantity} from '../api/documents';
import {difference, known, ratio, type Interval} from '../format/interval';
import {writeQuantity} from '../format/number';
import {factorBetween, unitsFor} from '../format/units';
import {listWords, sensorOf, spaced, writeSentence, writeUnit} from '../format/words';
import {defaultReadout, Figure} from '../figure/Figure';
import type {Numbers, Plot, Series} from '../figure/spec';
import {finite, valueAt} from '../figure/spec';
import {choose, hover, usePlace} from '../route';
import {Head} from '../shell/Head';
import {Report} from '../shell/Report';
import {Hairlines, Panel, Refusal, Segments} from '../shell/states';
import {useTitle} from '../shell/title';
import {Add} from './compare/Add';
import {nameApart, useSlot, type Item} from './compare/items';
import type {StructureDocument} from './device/documents';
import {measuredSeries, type Curve} from './recording/plots';

const MOST = 8;
const COLOURS = ['var(--r0)', 'var(--model)', 'var(--robust)', 'var(--c-gm)', 'var(--c-wn)', 'var(--c-rw)', 'var(--c-gm2)', 'var(--c-dr)'];
const MARKS = ['dot', 'square', 'triangle', 'diamond', 'open', 'dot', 'square', 'triangle'] as const;
const DASHES = ['', '7 4', '2 3', '10 3 2 3', '4 4', '1 3', '12 4', '3 6'];

interface Curved { item: Item; channel: Channel; i: number }
interface View { unit: string; curve: Curve; isByOneSecond: boolean }

const times = (values: Numbers | undefined, factor: number): Numbers => (values ?? []).map(value => finite(value) ? value * factor : null);

// Both ends of a long name: the one says what it is, the other which.
const short = (name: string): string => name.length > 24 ? `${name.slice(0, 15)}…${name.slice(-8)}` : name;

// A fit or a model is the curve that it implies, at the times of the recording; all else is what was measured.
function seriesOf({item, channel, i}: Curved, {unit, curve, isByOneSecond}: View): Series {
  const {implied} = item;
  const factor = factorBetween(channel.unit, unit);
  const style = {id: item.key, name: short(item.name), line: true, colour: COLOURS[i]!, ...(DASHES[i] ? {dash: DASHES[i]!} : {})};
  const {band: _band, ...measured} = measuredSeries(channel, factor, curve);
  const one: Series = implied ? {...style, x: implied.ratio.tau_s, y: times(implied.ratio.deviation, factor / (curve === 'haar' ? Math.SQRT2 : 1))} : {...measured, ...style, mark: MARKS[i]!, detail: ''};
  const by = isByOneSecond ? valueAt(one, 1, true) : null;
  return by === null ? one : {...one, y: times(one.y, 1 / by), low: times(one.low, 1 / by), high: times(one.high, 1 / by)};
}

function plotsOf(items: readonly Item[], view: View): Plot[] {
  const series = items.flatMap((item, i) => item.channel ? [seriesOf({item, channel: item.channel, i}, view)] : []);
  const first = series[0];
  if (!first) return [];
  const at = (one: Series, i: number): {value: number | null; ci95: (number | null)[]} => ({value: one.y[i] ?? null, ci95: [one.low?.[i] ?? null, one.high?.[i] ?? null]});
  const base = new Map(first.x.map((x, i) => [x.toPrecision(6), i] as const));
  // Uncertain is the first one too: its interval is in that of the ratio.
  const ratios = series.slice(1).map((one): Series => {
    const points = one.x.map((x, i) => { const j = base.get(x.toPrecision(6)); const by = j === undefined ? null : first.y[j]; const value = one.y[i]; if (j === undefined || !finite(by) || !finite(value)) return null; const [a, b] = [known(at(one, i)), known(at(first, j))]; return {y: value / by, ends: a && b ? ratio(a, b) : null}; });
    return {...one, id: `${one.id}-ratio`, noKey: true, line: !one.mark, y: points.map(point => point?.y ?? null), low: points.map(point => point?.ends?.[0] ?? null), high: points.map(point => point?.ends?.[1] ?? null)};
  });
  const name = `${view.curve === 'haar' ? 'Haar' : 'Allan'} deviation${view.isByOneSecond ? ' ÷ its own at 1 s' : `, ${writeUnit(view.unit)}`}`;
  const main: Plot = {id: 'deviation', equalDecades: true, x: {scale: 'log', name: ratios.length > 0 ? '' : 'averaging time τ, s'}, y: {scale: 'log', name}, series};
  return ratios.length > 0 ? [main, {id: 'ratio', height: 130, rules: [1], x: {scale: 'log', name: 'averaging time τ, s'}, y: {scale: 'log', name: `÷ ${first.name}`}, series: ratios}] : [main];
}

// What is stated is exactly what it is.
const ofItem = (item: Item, quantity: Quantity): ReturnType<typeof known> => known(item.given && quantity.value !== null ? {...quantity, ci95: [quantity.value, quantity.value]} : quantity);
const written = (value: number, ci95: Interval): string => { const {value: text, interval} = writeQuantity({value, unit: '', ci95: ci95[1] > ci95[0] ? ci95 : null}); return `${text} ${interval}`.trim(); };

// A parameter against that of the first item: by how much it differs, and whether that is shown.
function Against({first, item, name}: {first: Item; item: Item; name: string}): JSX.Element | null {
  const [mine, theirs] = [item.parameters.get(name), first.parameters.get(name)];
  if (!mine || !theirs) return null;
  const [a, b] = [ofItem(item, mine), ofItem(first, theirs)];
  if (!a || !b) return <div class="u">no interval to compare by</div>;
  if (item.given && first.given && a.value === b.value) return <div class="u">the same</div>;
  const ends = difference(a, b);
  const times = ratio(a, b);
  return <div class="u">{ends[0] > 0 || ends[1] < 0 ? 'differs by ' : 'no difference shown: '}{a.value > b.value && '+'}{written(a.value - b.value, ends)}{times && `, ${written(a.value / b.value, times)} times`}</div>;
}

function Table({items}: {items: readonly Item[]}): JSX.Element {
  const all = items.map(item => item.parameters);
  const names = [...new Set(all.flatMap(one => [...one.keys()]))];
  const cell = (item: Item, name: string, i: number): JSX.Element => {
    const quantity = item.parameters.get(name);
    const {value, interval} = writeQuantity(quantity ?? {value: null, unit: ''});
    return <td key={i} data-label={short(item.name)}>{item.parameters.has(name) ? <><b>{value}</b> <span class="ci">{interval}</span></> : '–'}{i > 0 && <Against first={items[0]!} item={item} name={name} />}</td>;
  };
  return <div class="scroll" tabIndex={0} role="region" aria-label="Parameters"><table class="stacked"><thead><tr><th scope="col">parameter</th>{items.map(item => <th key={item.key} scope="col" title={item.name}><bdi>{short(item.name)}</bdi> {!item.implied && <span class="u">{item.model}</span>}</th>)}</tr></thead>
    <tbody>{names.map(name => <tr key={name}><th scope="row">{name} <span class="u">{writeUnit(all.map(one => one.get(name)).find(Boolean)?.unit)}</span></th>{items.map((item, i) => cell(item, name, i))}</tr>)}</tbody></table></div>;
}

function Chip({item, name, onChange}: {item: Item | null; name: string; onChange: (key: string | null) => void}): JSX.Element {
  const pick = (event: JSX.TargetedEvent<HTMLSelectElement>): void => onChange(event.currentTarget.value);
  return <span class="chip"><bdi>{name}</bdi>
    {item && item.channels.length > 1 && <select aria-label={`Column of ${name}`} value={item.channels.find(([, column]) => column === item.channel?.channel)?.[0]} onChange={pick}>{item.channels.map(([key, column]) => <option key={key} value={key}>{column}</option>)}</select>}
    {item && item.fits.length > 1 && <select aria-label={`Curve of ${name}`} value={item.implied ? item.key : item.fits[0]![0]} onChange={pick}>{item.fits.map(([key, model]) => key && <option key={key} value={key}>{model}</option>)}</select>}
    <button type="button" aria-label={`Remove ${name}`} onClick={() => onChange(null)}>×</button></span>;
}

export default function Compare(): JSX.Element {
  const {query} = usePlace();
  useTitle('Compare');
  const wanted = (query.get('with') ?? '').split(',').filter(Boolean).slice(0, MOST);
  const slots = Array.from({length: MOST}, (_, i) => useSlot(wanted[i] ?? ''));
  const devices = useRead<List<Device>>('/v1/devices?limit=500');
  const [isAdding, setAdding] = useState(false);
  const deviceName = (id: string): string => devices.data?.items.find(one => one.id === id)?.name ?? '';
  const known = slots.flatMap(({item}) => item ? [item] : []);
  nameApart(known, deviceName);
  const items = known.filter(item => item.quantity === known[0]!.quantity);
  const others = known.filter(item => !items.includes(item));
  const units = items[0] ? unitsFor(items[0].unit) : [''];
  const view: View = {unit: units.find(unit => unit === query.get('unit')) ?? units[0]!, curve: query.get('fig') === 'haar' ? 'haar' : 'allan', isByOneSecond: query.get('norm') === '1s'};
  const set = (next: string[]): void => choose({with: [...new Set(next)].join(',') || null});
  const plots = useMemo(() => items.length > 0 ? plotsOf(items, view) : [], [items.map(item => item.key + item.name).join(), view.unit, view.curve, view.isByOneSecond]);
  const refused = slots.filter(({problem}, i) => problem && i < wanted.length);
  // A channel's own name may hold commas: the list's names are encoded by themselves.
  const told = [...new Set(items.flatMap(({channel, given, recording}) => channel && !given ? `${recording}:${encodeURIComponent(channel.channel)}` : []))];
  const structure = useRead<StructureDocument>(told.length > 1 ? `/v1/structures?of=${encodeURIComponent(told.join(','))}` : null);
  const measured = items.find(item => item.channel && !item.given);
  const leftOut = items.filter(item => item.leftOut.length > 0);
  const isOpen = isAdding || wanted.length === 0;
  return <>
    <Head title="Compare" facts={[`up to ${MOST} recordings, fits, conditions, models or data sheets`]} actions={<Report />} />
    <div class="chips">{wanted.map((key, i) => <Chip key={key} item={slots[i]!.item} name={slots[i]!.item?.name ?? slots[i]!.said} onChange={next => set(next === null ? wanted.filter((_, j) => j !== i) : wanted.map((each, j) => j === i ? next : each))} />)}
      {wanted.length > 0 && wanted.length < MOST && <button type="button" class="btn" aria-expanded={isOpen} onClick={() => setAdding(!isAdding)}>Add</button>}</div>
    {isOpen && wanted.length < MOST && <Add deviceName={deviceName} beside={measured && `~${measured.recording}~${encodeURIComponent(measured.channel!.channel)}`} onAdd={key => set([...wanted, key])} />}
    {refused.map(({problem, again, said}) => <Panel key={said}><Refusal problem={problem!} again={again} /></Panel>)}
    {slots.map(({lacks}, i) => lacks && i < wanted.length && <p key={i} class="note" role="status">{lacks}</p>)}
    {wanted.length === 0 && <p class="verdict">Choose what to compare: the same sensor before and after, two of a kind, conditions of one device, a simulation model or a data sheet beside them.</p>}
    {wanted.length > 0 && items.length === 0 && refused.length === 0 && !slots.some(({lacks}) => lacks) && <Panel title="Allan deviation"><Hairlines /></Panel>}
    {items.length > 0 && <>
      {structure.problem && <Refusal problem={structure.problem} again={structure.again} />}
      {told.length > 1 && structure.loading && <Hairlines />}
      {items.length > 1 && !structure.loading && <p class="verdict">{structure.data ? writeSentence(structure.data.statement) : told.length > 1 ? '' : told.length > 0 ? 'One recording, beside what is stated or fitted.' : 'What is stated, beside each other.'}{leftOut.map(item => <small key={item.key}>The curve of {item.name} is without what is no process of the noise: {listWords(item.leftOut.map(cause => cause === 'unnamed' ? 'effects without a name' : spaced(cause)))}.</small>)}{others.length > 0 && <small>Not drawn, of another sensor than the first: {listWords(others.map(item => `${item.name} (${sensorOf(item.quantity)})`))}.</small>}</p>}
      <div class="compared">{plots.length > 0 && <Figure name="compare" title={`${view.curve === 'haar' ? 'Haar' : 'Allan'} deviation`} plots={plots} source="driftlab" describe={`${view.curve === 'haar' ? 'Haar' : 'Allan'} deviations of ${items.filter(item => item.channel).map(item => item.name).join(', ')}, and their ratio to the first.`}
        controls={<Segments label="Curve" options={[['allan', 'Allan'], ['haar', 'Haar']] as const} value={view.curve} onChange={value => choose({fig: value === 'allan' ? null : value})} />}
        sub={<><label>normalise <select value={query.get('norm') ?? ''} onChange={event => choose({norm: event.currentTarget.value || null})}><option value="">not</option><option value="1s">each by its own at 1 s</option></select></label> <label>unit <select value={view.unit} disabled={view.isByOneSecond} onChange={event => choose({unit: event.currentTarget.value === units[0] ? null : event.currentTarget.value})}>{units.map(unit => <option key={unit} value={unit}>{writeUnit(unit)}</option>)}</select></label></>}
        cursor={Number(query.get('tau')) || null} onCursor={(x, pinned) => { if (pinned) hover({tau: x === null ? null : String(x)}); }} readout={x => <><b>τ {x} s</b>{defaultReadout(plots[0]!, x)}</>}
        {...(view.isByOneSecond ? {note: 'The deviation at 1 s is taken as it is: the others have only their own intervals.'} : {})} />}
      <Panel title="Parameters" sub="of the model ranked first, of the fit or model chosen, of a condition's recordings together, or as stated; the difference from the first and its 95 % interval"><Table items={items} /></Panel></div>
    </>}
  </>;
}
