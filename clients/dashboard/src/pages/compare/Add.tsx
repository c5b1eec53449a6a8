// What may be added to a comparison: what was recorded last, what is found by name (recordings, conditions of a device, simulation models), and
// the data sheet of a sensor.
import type {JSX} from 'preact';
import {useState} from 'preact/hooks';
import {useRead} from '../../api/client';
import type {DeviceSummary, List, Recording} from '../../api/documents';
import {conditionName, conditionText, sensorOf} from '../../format/words';
import {Refusal} from '../../shell/states';
import {useSheets} from '../datasheet/documents';
import {conditionKey} from './items';

interface Hit { kind: string; id: string; title: string; subtitle: string }
type Choice = readonly [key: string, text: string];

function Conditions({device, onAdd}: {device: string; onAdd: (key: string) => void}): JSX.Element | null {
  const summary = useRead<DeviceSummary>(`/v1/devices/${encodeURIComponent(device)}/summary`);
  const axes = (summary.data?.channels ?? []).filter(channel => channel.axis && ['angular_rate', 'specific_force'].includes(channel.quantity));
  const [nth, setNth] = useState(0);
  const axis = axes[nth];
  if (summary.problem) return <Refusal problem={summary.problem} />;
  if (summary.data && !axis) return <span class="sec">No recording of {device} is characterised.</span>;
  return <>{axes.length > 1 && <select aria-label="Sensor and axis" value={nth} onChange={event => setNth(Number(event.currentTarget.value))}>{axes.map((each, i) => <option key={i} value={i}>{sensorOf(each.quantity)} {each.axis}</option>)}</select>}
    {axis && summary.data!.conditions.map(({condition}) => condition && <button type="button" class="btn" key={conditionText(condition)} onClick={() => onAdd(conditionKey(device, conditionText(condition), sensorOf(axis.quantity), axis.axis!))}>{conditionName(condition, axis.axis)}</button>)}</>;
}

// `beside`: the recording's channel at whose times a model is drawn, as the address has it.
export function Add({onAdd, deviceName, beside = ''}: {onAdd: (key: string) => void; deviceName: (id: string) => string; beside?: string | undefined}): JSX.Element {
  const [text, setText] = useState('');
  const [device, setDevice] = useState('');
  const q = text.trim();
  const recent = useRead<List<Recording>>('/v1/recordings?sort=-created_at&has_result=true&limit=8');
  const found = useRead<{items: Hit[]}>(q ? `/v1/search?q=${encodeURIComponent(q)}&limit=12` : null);
  const add = (key: string): void => { setText(''); setDevice(''); onAdd(key); };
  const recordings: Choice[] = q ? (found.data?.items ?? []).filter(hit => hit.kind === 'recording').map(hit => [hit.id, `${hit.title}, ${hit.subtitle}`] as const)
    : (recent.data?.items ?? []).map(one => [one.id, [deviceName(one.device), one.metadata.id ?? one.id, conditionName(one.metadata.condition)].filter(Boolean).join(', ')] as const);
  const models: Choice[] = (found.data?.items ?? []).filter(hit => hit.kind === 'model').map(hit => [`${hit.id}${beside}`, hit.title] as const);
  const sheets: Choice[] = useSheets(q).flatMap(sheet => sheet.sensors.filter(each => each.N).map(each => [`sheet~${encodeURIComponent(sheet.name)}~${each.sensor}`, `Data sheet of ${sheet.name}, ${each.sensor}`] as const));
  const choices = [...recordings, ...models, ...sheets];
  const devices = (found.data?.items ?? []).filter(hit => hit.kind === 'device');
  return <div class="chips"><input type="search" aria-label="Find what to compare" placeholder="Recording, device, model, sensor" value={text} onInput={event => { setText(event.currentTarget.value); setDevice(''); }} />
    {device ? <Conditions device={device} onAdd={add} /> : <>
      {q && devices.map(hit => <button type="button" class="btn" key={hit.id} onClick={() => setDevice(hit.title)}>Conditions of {hit.title}</button>)}
      {choices.map(([key, name]) => <button type="button" class="btn" key={key} onClick={() => add(key)}>{name}</button>)}
      {q && found.data && devices.length + choices.length === 0 && <span class="sec">Nothing that can be compared is called so.</span>}
      {(recent.problem ?? found.problem) && <Refusal problem={(recent.problem ?? found.problem)!} again={() => { recent.again(); found.again(); }} />}</>}
  </div>;
}
