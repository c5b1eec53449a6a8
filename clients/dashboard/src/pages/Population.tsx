// All devices of one model: mean, spread and prediction of each parameter, the place of every device, and which is not of the line.
import type {JSX} from 'preact';
import {useMemo} from 'preact/hooks';
import {ask, useRead} from '../api/client';
import {writeNumber, writeP, writeQuantity, writeShare} from '../format/number';
import {capital, conditionName, listWords, plural, writeUnit} from '../format/words';
import {save} from '../figure/export';
import {Figure, Tools} from '../figure/Figure';
import {choose, listOf, pageOf, usePlace} from '../route';
import {Head, Verdict} from '../shell/Head';
import {usePageKeys} from '../shell/keys';
import {Report} from '../shell/Report';
import {curlOf} from '../shell/copy';
import {NextRows} from '../shell/Pager';
import {Panel, Segments, Shown} from '../shell/states';
import {useTitle} from '../shell/title';
import {sourceOf, useSheets, writeStated, type DataSheetDocument, type SensorSheet} from './datasheet/documents';
import {differBy, groupsOf, PARAMETERS, writeMean, type Group, type PlaceOf, type PopulationDocument, type PopulationRow} from './population/documents';
import {placesPlot} from './population/plots';

const ROWS = 50;

const axisName = (group: Group): string => `${group.sensor}${group.axis ? ` ${group.axis}` : ''}`;
const groupName = (group: Group): string => `${axisName(group)}, ${conditionName(group.condition, group.axis)}`;

// In the order that the address asks for.
function ordered(places: readonly PlaceOf[], byName: boolean): PlaceOf[] {
  return [...places].sort((a, b) => byName ? (a.device < b.device ? -1 : 1) : (a.estimate.value ?? 0) - (b.estimate.value ?? 0));
}

function sentence(row: PopulationRow): string {
  if (!row.mean) return row.reason ?? 'Too few devices identify it.';
  const mean = writeMean(row.mean);
  const parts = [`Mean ${mean.value} ${mean.interval} ${writeUnit(row.mean.unit)} of ${plural(row.places.length, 'device')}`];
  if (row.spread !== null) parts.push(differBy(row.spread) < 0.005 ? 'no difference between devices shows' : `devices differ by ${writeShare(differBy(row.spread))}`);
  if (row.prediction) parts.push(`a further one lies in [${row.prediction.map(end => writeNumber(end)).join(', ')}]`);
  return `${parts.join('; ')}.`;
}

function Readout({places, x}: {places: readonly PlaceOf[]; x: number}): JSX.Element {
  const place = places[Math.round(x) - 1];
  if (!place) return <span />;
  const written = writeQuantity(place.estimate);
  return <><b>{place.device}</b><span>{written.value} {written.interval} {writeUnit(place.estimate.unit)}</span>{place.quantile !== null && <span>above {writeShare(place.quantile)} of such</span>}{place.p_holm !== null && <span>{writeP(place.p_holm)}{place.outlying ? ', not of the line' : ''}</span>}</>;
}

function Parameter({row, sheet, model, path, byName}: {row: PopulationRow; sheet: SensorSheet | undefined; model: string; path: string; byName: boolean}): JSX.Element {
  const places = useMemo(() => ordered(row.places, byName), [row, byName]);
  const stated = row.parameter === 'N' && sheet?.N && sheet.N.unit === places[0]?.estimate.unit ? sheet.N.value : null;
  const plots = useMemo(() => [placesPlot(row, places, stated)], [row, places, stated]);
  const left = row.left_out.length > 0 && <details><summary>{plural(row.left_out.length, 'device')} left out</summary>{row.left_out.map(each => <div key={each.device}>{each.device}: {each.reason}</div>)}</details>;
  if (places.length === 0) return <Panel title={PARAMETERS[row.parameter]}><p>{row.reason ?? 'No device identifies it.'}</p>{left && <div class="note">{left}</div>}</Panel>;
  const outlying = places.filter(place => place.outlying).map(place => place.device);
  return <Figure name={`${model}-${row.sensor}-${row.axis ?? ''}-${row.parameter}-devices`} title={PARAMETERS[row.parameter]} sub={row.heterogeneity ? `one value for all: ${writeP(row.heterogeneity.p)}` : ''} plots={plots}
    describe={`${places.length} devices ${byName ? 'by name' : 'by value'} with 95 % intervals. ${sentence(row)} ${outlying.length > 0 ? `Not of the line: ${listWords(outlying)}.` : ''}`}
    readout={x => <Readout places={places} x={x} />} quietReadout={<span>{sentence(row)}</span>} source={`driftlab, ${model}, ${plural(places.length, 'device')}`} curl={curlOf(path)} how={() => <How />}
    note={<>{stated !== null && row.mean?.value ? `Its data sheet states ${writeStated(stated)} ${writeUnit(sheet?.N?.unit)}; the mean is ${writeNumber(row.mean.value / stated)} times that. ` : row.parameter === 'B' && sheet?.bias_stability ? `Its data sheet states an in-run bias stability of ${writeStated(sheet.bias_stability.value)} ${writeUnit(sheet.bias_stability.unit)}, which is 0.664 B. ` : ''}{row.mean ? '' : row.reason}{left}</>} />;
}

function How(): JSX.Element {
  return <><p>The logarithm of each estimate is the mean of the line, plus what is the device’s own, plus its error. The mean is weighted, the spread between devices by restricted maximum likelihood, the interval that of Hartung and Knapp.</p>
    <p>A device is set against the prediction from all others; what is flagged is below 5 % after Holm’s correction over the devices. <a href="/docs/populations">The manual</a> says how often it is right. Nothing here is drawn at random; the seed and algorithm version of each estimate stand with its recording.</p></>;
}

function Devices({group, byName, path, model, from}: {group: Group; byName: boolean; path: string; model: string; from: number}): JSX.Element {
  const first = group.rows[0];
  const names = new Map<string, Map<string, PlaceOf>>();
  const leading = first ? ordered(first.places, byName) : [];
  for (const place of [...leading, ...group.rows.flatMap(row => row.places)]) if (!names.has(place.device)) names.set(place.device, new Map());
  for (const row of group.rows) for (const place of row.places) names.get(place.device)!.set(row.parameter, place);
  const all = [...names];
  const text = async (): Promise<void> => save(`${model}.csv`, 'text/csv', await (await ask(path, {headers: {Accept: 'text/csv'}})).text());
  return <Panel title="Devices" sub={byName ? 'by name' : `by ${first?.parameter ?? 'value'}, as in its figure`} tools={<Tools title="The places" onCsv={() => void text()} curl={curlOf(path)} how={How} />}>
    <div class="scroll"><table class="stacked">
      <thead><tr><th scope="col" class="n">place</th><th scope="col">device</th>{group.rows.map(row => <th key={row.parameter} scope="col">{PARAMETERS[row.parameter]} <span class="u">{writeUnit(row.places[0]?.estimate.unit)}</span></th>)}<th scope="col">among the others</th></tr></thead>
      <tbody>{all.slice(from, from + ROWS).map(([device, places], i) => { const outlying = [...places.values()].filter(place => place.outlying); return <tr key={device}>
        <td class="n dim desk-only">{from + i + 1}</td><th scope="row"><a href={pageOf('devices', device)}>{device}</a></th>
        {group.rows.map(row => { const place = places.get(row.parameter); if (!place) return <td key={row.parameter} data-label={row.parameter} title={row.left_out.find(each => each.device === device)?.reason}>…</td>; const written = writeQuantity(place.estimate); return <td key={row.parameter} data-label={row.parameter}><b>{written.value}</b> <span class="ci">{written.interval}</span></td>; })}
        <td>{outlying.length > 0 ? outlying.map(place => <div key={place.device}><span class="g warn" aria-hidden="true">△ </span>not of the line, {writeP(place.p_holm)}</div>) : <span class="sec">{places.get('N')?.quantile != null ? `above ${writeShare(places.get('N')!.quantile!)} in N` : '–'}</span>}</td>
      </tr>; })}</tbody></table></div>
    <NextRows from={from} rows={ROWS} count={all.length} />
    <p class="note">… the data of the device do not identify it. A share says in how many of 100 devices with such data the value would be lower.</p>
  </Panel>;
}

function SheetNote({sheet, sensor}: {sheet: DataSheetDocument; sensor: SensorSheet | undefined}): JSX.Element {
  return <p class="note">The model is a sensor with a <a href={pageOf('data-sheets', sheet.name)}>data sheet</a>{sensor ? `: ${sourceOf(sheet)}, ${sensor.place}.` : '; it says nothing of this sensor.'}</p>;
}

function Body({document, path}: {document: PopulationDocument; path: string}): JSX.Element {
  const {query} = usePlace();
  const sheets = useSheets(document.model);
  const groups = useMemo(() => groupsOf(document.rows), [document]);
  const group = groups.find(each => each.key === query.get('of')) ?? groups[0];
  const byName = query.get('order') === 'name';
  const at = group ? groups.indexOf(group) : 0;
  const pick = (key: string): void => choose({of: key === groups[0]?.key ? null : key, from: null});
  const step = (by: number): void => { const next = groups[(at + by + groups.length) % Math.max(1, groups.length)]; if (next) pick(next.key); };
  usePageKeys({'[': () => step(-1), ']': () => step(1)});
  const sheet = sheets.find(each => each.sensors.some(sensor => sensor.sensor === group?.sensor)) ?? sheets[0];
  const sensor = sheet?.sensors.find(each => each.sensor === group?.sensor);
  return <>
    <Verdict summary={document.summary} />
    {!group ? <Panel title="No population"><p class="sec">No device has a parameter that could be compared. Characterise a recording of each.</p></Panel> : <>
      <div class="row no-print">
        {groups.length > 6 ? <label>population <select value={group.key} onChange={event => pick(event.currentTarget.value)}>{groups.map(each => <option key={each.key} value={each.key}>{groupName(each)}</option>)}</select></label>
          : groups.length > 1 ? <Segments label="Population" options={groups.map(each => [each.key, groupName(each)] as const)} value={group.key} onChange={pick} /> : <b>{capital(groupName(group))}</b>}
        <Segments label="Order" options={[['value', 'By value'], ['name', 'By name']] as const} value={byName ? 'name' : 'value'} onChange={value => choose({order: value === 'name' ? 'name' : null, from: null})} />
      </div>
      {sheet && <SheetNote sheet={sheet} sensor={sensor} />}
      <div class="grid three">{group.rows.map(row => <Parameter key={`${group.key}${row.parameter}`} row={row} sheet={sensor} model={document.model} path={path} byName={byName} />)}</div>
      <Devices group={group} byName={byName} path={path} model={document.model} from={Math.max(0, Number(query.get('from')) || 0)} />
    </>}
  </>;
}

export default function Population(): JSX.Element {
  const {parts} = usePlace();
  const model = parts[1] ?? '';
  const path = `/v1/populations?model=${encodeURIComponent(model)}`;
  const read = useRead<PopulationDocument>(path);
  useTitle(model);
  return <>
    <Head crumb={[['Populations', listOf('populations')], [model, null]]} title={model} facts={[read.data && plural(read.data.devices.length, 'device with results', 'devices with results'), read.data && plural(read.data.rows.length, 'population')]} actions={<Report />} />
    <Shown read={read}>{document => <Body document={document} path={path} />}</Shown>
  </>;
}
