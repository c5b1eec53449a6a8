// One recorded drive: what its files are, what the filter is told, what was asked of it.
import type {JSX} from 'preact';
import {useRead} from '../api/client';
import type {Device, List} from '../api/documents';
import {writeTick} from '../format/number';
import {writeWhen} from '../format/time';
import {capital, plural, processName, symbolOf, writeUnit} from '../format/words';
import {listOf, pageOf, usePlace} from '../route';
import {Head} from '../shell/Head';
import {copy, curlOf} from '../shell/copy';
import {Panel, Shown} from '../shell/states';
import {useTitle} from '../shell/title';
import {Ask} from './drive/Ask';
import {inWords, type DriveText, type Evaluation, type EvaluationRow, type Source, type StoredDrive} from './drive/documents';
import {Evaluations} from './drive/Evaluations';
import {driveSentence, FactsPanel} from './drive/Facts';

const RECENT = 50;
const REFERENCES: Record<string, string> = {withheld_fixes: 'the fixes that are withheld', smoothed_fixes: 'its path smoothed over all fixes'};

const sourcesOf = (drive: DriveText): [string, Source][] => [
  ['inertial unit', drive.imu], ...(drive.imu.accelerometer ? [['accelerometer', drive.imu.accelerometer] as [string, Source]] : []), ['fixes', drive.gnss],
  ...(typeof drive.reference === 'object' ? [['reference', drive.reference] as [string, Source]] : []), ...(drive.odometer ? [['odometer', drive.odometer] as [string, Source]] : []),
];

function Sources({drive}: {drive: DriveText}): JSX.Element {
  return <Panel title="Sources" sub={`reference: ${typeof drive.reference === 'object' ? 'a source of its own' : REFERENCES[drive.reference ?? 'withheld_fixes']}`}>
    <div class="scroll"><table class="stacked"><thead><tr><th scope="col">source</th><th scope="col">recording</th><th scope="col">columns</th><th scope="col">time</th></tr></thead>
      <tbody>{sourcesOf(drive).map(([name, source]) => { const quantities = [...new Set(Object.values(source.columns).map(column => column.quantity).filter(quantity => quantity !== 'ignored'))]; return <tr key={name}>
        <th scope="row">{name}</th><td>{source.recording ? <a href={pageOf('recordings', source.recording)}>{source.recording.slice(0, 8)}…{source.recording.slice(-4)}</a> : '–'}</td>
        <td class="sec">{quantities.map(inWords).join(', ')}</td><td class="sec">{source.time.scale === 'row' ? `rows at ${source.time.rate_hz ?? '…'} Hz` : `${source.time.scale}, ${source.time.unit ?? 's'}`}</td></tr>; })}</tbody></table></div>
    {drive.imu.clock && drive.imu.clock !== 'sensor' && <p class="note">Rows of the unit are stamped by {drive.imu.clock === 'host' ? 'the computer that asks' : 'the computer that receives them'}.</p>}
  </Panel>;
}

// Members of a model that end in their unit.
const UNITS: Record<string, string> = {deg_s: 'deg/s', deg_h: 'deg/h', mg: 'mg', mg_per_sqrt_hz: 'mg/sqrt(Hz)'};
const UNIT_OF = /^(.*?)(_sd)?_(deg_s|deg_h|mg_per_sqrt_hz|mg)$/;

// What a sensor's model says, as lines of a name and a value, whatever way it is stated.
function told(stated: unknown, name = ''): [string, string][] {
  const under = (key: string): string => [name, inWords(key)].filter(Boolean).join(' ');
  if (Array.isArray(stated)) return stated.flatMap(each => told(each, name));
  if (typeof stated !== 'object' || stated === null) return [[name, typeof stated === 'number' ? writeTick(stated) : String(stated)]];
  const {value, unit, process, params, ...rest} = stated as {value?: unknown; unit?: unknown; process?: unknown; params?: unknown};
  if (typeof value === 'number' && typeof unit === 'string') return [[name, `${writeTick(value)} ${writeUnit(unit)}`]];
  if (typeof process === 'string' && typeof params === 'object' && params) return Object.entries(params).flatMap(([key, each]) => told(each, `${processName(process)} ${symbolOf(key)}`));
  return Object.entries(rest).flatMap(([key, each]): [string, string][] => {
    const [, what = '', spread, unitName = ''] = UNIT_OF.exec(key) ?? [];
    if (unitName && typeof each === 'number') return [[`${under(what)}${spread ? ', 1 σ' : ''}`, `${writeTick(each)} ${writeUnit(UNITS[unitName])}`]];
    return told(each, key === 'processes' ? name : under(key));
  });
}

function Believed({drive}: {drive: StoredDrive}): JSX.Element {
  const {outages} = drive.drive;
  const path = `/v1/drives/${drive.id}`;
  return <Panel title="What the filter is told" sub={outages?.at ? `${plural(outages.at.length, 'outage')} at given times` : `outages of ${(outages?.duration_s ?? [10, 30, 60]).join(', ')} s, ${outages?.phases ?? 8} phases`}
    tools={<div class="tools"><button type="button" class="quiet" onClick={() => copy(curlOf(path), 'The command is')}>curl</button><button type="button" class="quiet" onClick={() => copy(JSON.stringify(drive.drive, null, 2), 'The document is')}>Copy the document</button></div>}>
    <table class="params"><tbody>{(['gyroscope', 'accelerometer'] as const).flatMap(sensor => told(drive.drive.model[sensor]).map(([name, value], i) =>
      <tr key={`${sensor}${i}`}><th scope="row">{i === 0 ? capital(sensor) : <span class="visually-hidden">{sensor}</span>}</th><td>{capital(name)}</td><td class="n"><b>{value}</b></td></tr>))}</tbody></table>
  </Panel>;
}

function Body({drive}: {drive: StoredDrive}): JSX.Element {
  const device = useRead<Device>(`/v1/devices/${drive.device}`);
  const asked = useRead<List<EvaluationRow>>(`/v1/drive-evaluations?sort=-created_at&limit=${RECENT}`, 3000);
  const mine = asked.data?.items.filter(row => row.drive === drive.id) ?? [];
  const latest = mine.find(row => row.state === 'succeeded');
  const read = useRead<Evaluation>(latest ? `/v1/drive-evaluations/${latest.id}` : null);
  const facts = read.data?.evaluation?.facts;
  return <>
    <Head crumb={[['Recorded drives', listOf('drives')], [drive.name, null]]} title={drive.name} facts={[drive.vehicle, device.data && <a href={pageOf('devices', device.data.name)}>{device.data.name}</a>, `stored ${writeWhen(drive.created_at)}`]} />
    {facts ? <p class="verdict">{driveSentence(facts)}{read.data?.evaluation && <small>{read.data.evaluation.summary}</small>}</p> : asked.data && !latest && <p class="verdict">Nothing was measured on it yet.</p>}
    <div class="grid two">
      <div class="stack"><Ask drive={drive} />
        <Panel title="Asked of it" sub={asked.data?.next_cursor ? `among the newest ${RECENT} of all drives` : 'newest first'}><Shown read={asked}>{() => mine.length === 0 ? <p class="sec">Nothing yet.</p> : <Evaluations rows={mine} named={false} />}</Shown></Panel></div>
      <div class="stack">{facts && <FactsPanel facts={facts} />}<Sources drive={drive.drive} /><Believed drive={drive} /></div>
    </div>
  </>;
}

export default function Drive(): JSX.Element {
  const {parts} = usePlace();
  const read = useRead<StoredDrive>(`/v1/drives/${encodeURIComponent(parts[1] ?? '')}`);
  useTitle(read.data?.name ?? 'Drive');
  return <Shown read={read} page="Drive">{drive => <Body drive={drive} />}</Shown>;
}
