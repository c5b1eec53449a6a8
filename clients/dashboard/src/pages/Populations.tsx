// The models of which there are devices, and how many of each are not of the line.
import type {JSX} from 'preact';
import {useState} from 'preact/hooks';
import {useRead} from '../api/client';
import type {Device, List} from '../api/documents';
import {listWords, plural} from '../format/words';
import {go, pageOf, usePlace} from '../route';
import {Head} from '../shell/Head';
import {NextRows} from '../shell/Pager';
import {Panel, Shown} from '../shell/states';
import {Tabs} from '../shell/Tabs';
import {useTitle} from '../shell/title';
import type {PopulationDocument} from './population/documents';
import {useSheets} from './datasheet/documents';

const MOST_READ = 500;
const ROWS = 50;
const ASKED = 12;  // populations that are read for the list; the others on a click

interface Model { name: string; devices: string[] }

// A device is of the model and of the IMU that it states, whatever the case.
function modelsOf(devices: readonly Device[]): Model[] {
  const models = new Map<string, Model>();
  for (const device of devices) {
    for (const text of new Set([device.model, device.imu].map(each => each?.trim() ?? '').filter(Boolean))) {
      const model = models.get(text.toLowerCase()) ?? {name: text, devices: []};
      if (!model.devices.includes(device.name)) model.devices.push(device.name);
      models.set(text.toLowerCase(), model);
    }
  }
  return [...models.values()].sort((a, b) => b.devices.length - a.devices.length || (a.name < b.name ? -1 : 1));
}

function flagged(document: PopulationDocument): string {
  const names = [...new Set(document.outlying.map(flag => flag.device))];
  return names.length > 4 ? `${names.slice(0, 4).join(', ')} and ${names.length - 4} more` : listWords(names);
}

function Row({model, ask}: {model: Model; ask: boolean}): JSX.Element {
  const read = useRead<PopulationDocument>(ask ? `/v1/populations?model=${encodeURIComponent(model.name)}` : null);
  const sheets = useSheets(model.name);
  const href = pageOf('populations', model.name);
  return <tr>
    <th scope="row"><a href={href}>{model.name}</a></th>
    <td class="n" data-label="devices">{model.devices.length}</td>
    <td class="sec">{sheets.length > 0 ? sheets.map(sheet => <a key={sheet.name} href={pageOf('data-sheets', sheet.name)}>{sheet.name}</a>) : '–'}</td>
    <td class="n" data-label="populations">{read.data ? read.data.rows.length : read.problem ? '–' : ask ? '' : <a href={href}>show</a>}</td>
    <td>{read.data ? read.data.outlying.length > 0 ? <><span class="g warn" aria-hidden="true">△ </span>{flagged(read.data)}</> : <span class="sec">none</span> : <span class="sec">{read.problem ? read.problem.document.detail : ''}</span>}</td>
  </tr>;
}

function OfModel(): JSX.Element {
  const [name, setName] = useState('');
  return <form class="row" onSubmit={event => { event.preventDefault(); if (name.trim()) go(pageOf('populations', name.trim())); }}>
    <input type="text" aria-label="Model or IMU" placeholder="Model or IMU" value={name} onInput={event => setName(event.currentTarget.value)} /><button type="submit" class="btn">Show</button>
  </form>;
}

export default function Populations(): JSX.Element {
  const {query} = usePlace();
  useTitle('Populations');
  const read = useRead<List<Device>>(`/v1/devices?sort=-created_at&limit=${MOST_READ}`);
  const from = Math.max(0, Number(query.get('from')) || 0);
  const models = read.data ? modelsOf(read.data.items) : [];
  const shown = models.slice(from, from + ROWS);
  return <>
    <Head title="Populations" facts={['all devices of a model, and which of them is not of the line', read.data && plural(models.length, 'model')]} actions={<OfModel />} />
    <Tabs group="devices" />
    <Shown read={read}>{list => models.length === 0
      ? <Panel title="No device states its model"><p>Devices of one model are set against each other: how much they differ, where a further one will lie, and which stands out. Say of which model a device is, here for one that exists:</p>
        <pre tabIndex={0}><code>{`curl --request PATCH --header 'If-Match: *' --json '{"model": "MPU-6050"}' ${window.location.origin}/v1/devices/${list.items[0]?.name ?? 'unit-01'}`}</code></pre><p><a href="/docs/populations">How populations are estimated</a></p></Panel>
      : <Panel title="Models" sub={list.next_cursor ? `of the newest ${MOST_READ} devices` : 'the most devices first'}>
        <div class="scroll"><table class="stacked">
          <thead><tr><th scope="col">model or IMU</th><th scope="col" class="n">devices</th><th scope="col">data sheet</th><th scope="col" class="n">populations</th><th scope="col">not of the line</th></tr></thead>
          <tbody>{shown.map((model, i) => <Row key={model.name} model={model} ask={i < ASKED} />)}</tbody></table></div>
        <NextRows from={from} rows={ROWS} count={models.length} />
      </Panel>}</Shown>
  </>;
}
