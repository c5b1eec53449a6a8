// One device: its parameters by condition, how they move, its recordings.
import type {JSX} from 'preact';
import {useEffect, useMemo, useState} from 'preact/hooks';
import {ask, Problem, remove, useRead} from '../api/client';
import type {Characterisation, Device, DeviceSummary, List, Recording} from '../api/documents';
import {writeWhen} from '../format/time';
import {factorBetween, unitsFor} from '../format/units';
import {conditionName, conditionText, plural, sensorOf, writeUnit} from '../format/words';
import {defaultReadout, Figure, Tools} from '../figure/Figure';
import {save} from '../figure/export';
import type {Plot, Series} from '../figure/spec';
import {choose, go, hover, pageOf, usePlace} from '../route';
import {Characterise} from '../shell/Characterise';
import {Delete} from '../shell/Delete';
import {Head, Verdict} from '../shell/Head';
import {usePageKeys} from '../shell/keys';
import {LiveLine, useLiveJobs} from '../shell/Live';
import {MadeFrom, Report} from '../shell/Report';
import {curlOf} from '../shell/copy';
import {say} from '../shell/say';
import {Hairlines, Panel, Refusal, Segments, Shown} from '../shell/states';
import {useTitle} from '../shell/title';
import {conditionKey} from './compare/items';
import {colours, type ParameterTable, type Trends} from './device/documents';
import {ExportModel} from './device/ExportModel';
import {Recordings} from './device/Recordings';
import {Structure} from './device/Structure';
import {Parameters} from './device/Table';
import {SheetLine} from './device/SheetLine';
import {TrendFrame} from './device/TrendPanel';

const CONDITIONS = 8;
const WAITS_MS = 2500;

function Overlay({table, rows}: {table: ParameterTable; rows: readonly number[]}): JSX.Element | null {
  const {query} = usePlace();
  const shown = rows.slice(0, CONDITIONS);
  const reads = Array.from({length: CONDITIONS}, (_, i) => useRead<Characterisation>(shown[i] === undefined ? null : `/v1/recordings/${table.rows[shown[i]!]!.recordings[0]}/characterisation`));
  const colour = colours(table.rows);
  const quantity = table.sensor === 'accelerometer' ? 'specific_force' : 'angular_rate';
  const known = reads.map(read => read.data);
  const plots = useMemo((): Plot[] => {
    let unit = '';
    const series = shown.flatMap((row, i): Series[] => {
      const channel = known[i]?.channels.find(one => one.result.quantity === quantity && one.result.axis === table.axis)?.result;
      if (!channel) return [];
      unit = unitsFor(channel.unit)[0]!;
      const factor = factorBetween(channel.unit, unit);
      const times = (values: readonly (number | null | undefined)[]): (number | null)[] => values.map(value => value === null || value === undefined ? null : value * factor);
      const acceleration = table.rows[row]!.condition.kind === 'constant_angular_acceleration';
      return [{id: table.rows[row]!.label, name: conditionName(table.rows[row]!.condition, table.axis), x: channel.allan.tau_s, y: times(channel.allan.deviation), low: times(channel.allan.ci95.map(ends => ends[0])), high: times(channel.allan.ci95.map(ends => ends[1])), mark: acceleration ? 'open' : 'dot', line: true, colour: colour[row]!, ...(acceleration ? {dash: '5 3'} : {})}];
    });
    // The keys stand in the order of the curves at the shortest time.
    series.sort((a, b) => (b.y[0] ?? 0) - (a.y[0] ?? 0));
    return [{id: 'overlay', equalDecades: true, x: {scale: 'log', name: 'averaging time τ, s'}, y: {scale: 'log', name: `Allan deviation, ${writeUnit(unit)}`}, series}];
  }, [table, shown.join(), known.map(each => each?.job).join()]);
  if ((plots[0]?.series.length ?? 0) === 0) return <Panel title="Allan deviation by condition"><Hairlines /></Panel>;
  const tau = Number(query.get('tau')) || null;
  return <Figure name={`${table.device}-${table.axis}-allan`} title="Allan deviation by condition" sub="first recording of each" plots={plots} source={`driftlab, ${table.device}, ${table.sensor} ${table.axis ?? ''}`}
    describe={`Allan deviations of ${plots[0]!.series.map(one => one.name).join(', ')}, log-log with equal decades.`} cursor={tau} onCursor={(x, pinned) => { if (pinned) hover({tau: x === null ? null : String(x)}); }}
    readout={x => <><b>τ {x} s</b>{defaultReadout(plots[0]!, x)}</>} note="Rates are one ordered ramp, angular accelerations another, dashed with open marks." />;
}

// The model of the table: the best over all rows unless another of those that were compared is chosen.
function Model({table, chosen}: {table: ParameterTable; chosen: string | null}): JSX.Element {
  const models = table.structure?.ranking.map(each => each.model) ?? [];
  if (models.length < 2) return <span class="sub">model <b>{table.model}</b>{chosen ? <> <button type="button" class="link" onClick={() => choose({model: null})}>best over all rows</button></> : ', best over all rows'}</span>;
  return <label class="sub">model <select value={chosen ?? ''} onChange={event => choose({model: event.currentTarget.value || null})}>
    <option value="">{models[0]}, best over all rows</option>{models.map(each => <option key={each} value={each}>{each}</option>)}</select></label>;
}

// `onCompared`: told what a comparison would show, its conditions.
// `live`: jobs work on its recordings, and the table fills as they end.
function Results({device, summary, live, onCompared}: {device: Device; summary: DeviceSummary; live: boolean; onCompared: (items: string) => void}): JSX.Element {
  const {query} = usePlace();
  const axes = summary.channels.filter(channel => channel.axis && ['angular_rate', 'specific_force'].includes(channel.quantity));
  const wanted = `${query.get('sensor') ?? ''}:${query.get('axis') ?? ''}`;
  const chosen = axes.find(channel => `${sensorOf(channel.quantity)}:${channel.axis}` === wanted) ?? axes.find(channel => channel.quantity === 'angular_rate') ?? axes[0];
  const method = query.get('method') === 'av' ? 'av' : 'gmwm';
  const model = query.get('model');
  const asked = chosen ? `/v1/parameter-tables?device=${device.id}&sensor=${sensorOf(chosen.quantity)}&axis=${chosen.axis}&method=${method}${model && method === 'gmwm' ? `&model=${encodeURIComponent(model)}` : ''}` : null;
  const reference = query.get('ref');
  const path = asked && reference ? `${asked}&reference=${encodeURIComponent(reference)}` : asked;
  const [watched, setWatched] = useState(live);
  const everyMs = watched ? WAITS_MS : undefined;
  const read = useRead<ParameterTable>(path, everyMs);
  const trends = useRead<Trends>(asked ? asked.replace('/v1/parameter-tables', '/v1/trends') : null, everyMs);
  const pooling = read.data?.pooling.state === 'pending';
  // Watched while a job works on the device or its recordings are being pooled; then nothing changes under a reader's eyes any more.
  useEffect(() => {
    const on = live || pooling;  // a pool may be seen only by what is read after its last member
    if (watched ? !live : on) { read.again(); trends.again(); }
    setWatched(on);
  }, [live, pooling]);
  const compared = (read.data?.rows ?? []).slice(0, CONDITIONS).map(row => conditionKey(device.name, conditionText(row.condition), read.data!.sensor, read.data!.axis ?? '')).join(',');
  const colour = useMemo(() => new Map(read.data ? colours(read.data.rows).map((one, i) => [read.data!.rows[i]!.label, one] as const) : []), [read.data]);
  const select = (axis: string): void => choose({axis, sensor: chosen ? sensorOf(chosen.quantity) : null});
  usePageKeys({1: () => select('x'), 2: () => select('y'), 3: () => select('z'), c: () => { if (compared) go(`/compare?with=${encodeURIComponent(compared)}`); }});
  useEffect(() => onCompared(compared), [compared]);
  if (!chosen || !path) return live ? <></> : <p class="verdict">No results yet. {plural(summary.recordings, 'recording')} wait{summary.recordings === 1 ? 's' : ''}. <CharacteriseAll device={device} /></p>;
  const text = async (type: string, extension: string): Promise<void> => save(`${device.name}-${chosen.axis}.${extension}`, type, await (await ask(path, {headers: {Accept: type}})).text());
  const selected = (query.get('sel') ?? '').split('|').filter(Boolean);
  const against = query.get('trend') === 'acceleration' ? 'angular_acceleration' : 'rate';
  const shown = (trends.data?.trends ?? []).filter(trend => trend.against.kind === against && trend.points.length > 0);
  return <>
    {read.data?.summary && <Verdict summary={read.data.summary} />}
    <section class="panel">
      <div class="ptop"><h2>Parameters by condition</h2>
        <Segments label="Sensor and axis" options={axes.map(channel => [`${sensorOf(channel.quantity)}:${channel.axis}`, `${channel.quantity === 'angular_rate' ? 'ω' : 'f'} ${channel.axis}`] as const)} value={`${sensorOf(chosen.quantity)}:${chosen.axis}`} onChange={value => { const [sensor = null, axis = null] = value.split(':'); choose({sensor, axis, sel: null, ref: null}); }} />
        <Segments label="Method" options={[['gmwm', 'GMWM'], ['av', 'Allan']] as const} value={method} onChange={value => choose({method: value === 'gmwm' ? null : value})} />
        {read.data?.model && <Model table={read.data} chosen={model} />}
        <div class="tools"><button type="button" class="quiet" onClick={() => void text('text/csv', 'csv')}>CSV</button><button type="button" class="quiet" onClick={() => void text('text/markdown', 'md')}>Markdown</button><button type="button" class="quiet" onClick={() => void text('text/x-latex', 'tex')}>LaTeX</button></div>
        <Tools title="The table" curl={curlOf(path)} how={() => <p>Each row puts the recordings of one condition together, jointly where a job has fitted them so. All rows share one model. <a href="/docs/analysis">The manual</a> tells of intervals, agreement and arrows. The report lists seed, algorithm version and file hash of each recording.</p>} />
      </div>
      {pooling && <p class="note">The recordings of one condition are still being fitted jointly; until then their values are averaged.</p>}
      <Shown read={read}>{table => <><Parameters table={table} />{table.data_sheet && <SheetLine comparison={table.data_sheet} />}</>}</Shown>
    </section>
    {read.data && <div class="grid two">
      <div class="stack"><Overlay table={read.data} rows={read.data.rows.map((_, i) => i).filter(i => selected.length === 0 || selected.includes(read.data!.rows[i]!.label))} /><Structure table={read.data} /></div>
      <Panel title={`Trends against ${against === 'rate' ? 'rate' : 'angular acceleration'}`} controls={<Segments label="Against" options={[['rate', '|rate|'], ['acceleration', '|acceleration|']] as const} value={against === 'rate' ? 'rate' : 'acceleration'} onChange={value => choose({trend: value === 'rate' ? null : value})} />}>
        {trends.problem ? <Refusal problem={trends.problem} again={trends.again} /> : !trends.data ? <Hairlines /> : shown.length === 0 ? <p class="sec">One condition shows no trend. Record this device while it turns at a known rate.</p>
          : <><div class="small-multiples">{shown.map(trend => <TrendFrame key={trend.parameter} trend={trend} device={device.name} colour={colour} />)}</div><p class="note">Zero is on every axis. “Moves” rejects equality at 5 %; “rises” or “falls” only where the trend itself does. … not identified.</p></>}
      </Panel>
    </div>}
    <Recordings device={device} axis={chosen.axis} />
    {read.data && <MadeFrom recordings={[...new Set(read.data.rows.flatMap(row => row.recordings))]} />}
  </>;
}

// What it is, each text leading to the other devices of that model.
function Unit({device}: {device: Device}): JSX.Element {
  const models = [...new Set([device.model, device.imu].filter((text): text is string => Boolean(text)))];
  return <>{models.map((text, i) => <span key={text}>{i > 0 && ', '}<a href={pageOf('populations', text)} title={`All devices of ${text}`}>{text}</a></span>)}{device.serial && `${models.length > 0 ? ', ' : ''}${device.serial}`}</>;
}

function CharacteriseAll({device}: {device: Device}): JSX.Element | null {
  const read = useRead<List<Recording>>(`/v1/recordings?device=${device.id}&limit=100`);
  if (!read.data || read.data.items.length === 0) return null;
  return <Characterise recordings={read.data.items.map(one => one.id)} label="Characterise" onQueued={job => go(pageOf('jobs', job.id))} />;
}

export default function DevicePage(): JSX.Element {
  const {parts} = usePlace();
  const name = parts[1] ?? '';
  const read = useRead<Device>(`/v1/devices/${encodeURIComponent(name)}`);
  const [waits, setWaits] = useState(true);
  const [compared, setCompared] = useState('');
  const [refused, setRefused] = useState<Problem>();
  const forget = (device: Device): void => { remove(`/v1/devices/${device.id}`).then(() => { say(`${device.name} is deleted.`); go('/devices', {replace: true}); }, error => setRefused(error as Problem)); };
  const live = useLiveJobs(read.data?.id ?? null);
  const summary = useRead<DeviceSummary>(read.data ? `/v1/devices/${read.data.id}/summary` : null, waits || live.length > 0 ? WAITS_MS : undefined);
  // Until there is a first result the page looks for one.
  useEffect(() => { if (summary.data) setWaits(summary.data.channels.length === 0); }, [summary.data]);
  useTitle(read.data?.name ?? name);
  return <Shown read={read} page="Device">{device => <>
    <Head crumb={[['Devices', '/devices'], [device.name, null]]} title={device.name}
      facts={[summary.data && plural(summary.data.recordings, 'recording'), summary.data && plural(summary.data.conditions.length, 'condition'), (device.model || device.imu || device.serial) && <Unit device={device} />, summary.data?.latest && `last result ${writeWhen(summary.data.latest.at)}`]}
      actions={<><a class="btn" href={`/upload`}>Add recordings</a>{compared && <a class="btn" href={`/compare?with=${encodeURIComponent(compared)}`}>Compare <kbd>c</kbd></a>}<a class="btn" href={`/investigations?device=${encodeURIComponent(device.name)}`}>Investigate</a>{compared && <ExportModel device={device.name} />}<Report /><Delete title={`Delete ${device.name}?`} onDelete={() => forget(device)}>It is refused while recordings, studies, models or running jobs depend on it.</Delete></>} />
    {refused && <Refusal problem={refused} />}
    <LiveLine jobs={live} />
    <Shown read={summary}>{found => <><Results device={device} summary={found} live={live.length > 0} onCompared={setCompared} />{found.channels.length === 0 && <Recordings device={device} axis={null} />}</>}</Shown>
  </>}</Shown>;
}
