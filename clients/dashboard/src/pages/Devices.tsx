// Every device, newest first.
import type {JSX} from 'preact';
import {useRead} from '../api/client';
import type {Device, List} from '../api/documents';
import {conditionName} from '../format/words';
import {pageOf, usePlace} from '../route';
import {Head} from '../shell/Head';
import {LastResult} from '../shell/LastResult';
import {Sought} from '../shell/Sought';
import {Pager} from '../shell/Pager';
import {Panel, Shown} from '../shell/states';
import {Tabs} from '../shell/Tabs';
import {useTitle} from '../shell/title';

export default function Devices(): JSX.Element {
  const {query} = usePlace();
  useTitle('Devices');
  const after = query.get('after');
  const q = query.get('q') ?? '';
  const read = useRead<List<Device>>(`/v1/devices?include=summary&sort=-created_at&limit=50${q ? `&q=${encodeURIComponent(q)}` : ''}${after ? `&cursor=${after}` : ''}`, 5000);
  return <>
    <Head title="Devices" facts={['newest first']} actions={<Sought label="Only names and models with" />} />
    <Tabs group="devices" />
    <Panel><Shown read={read}>{list => {
      const shown = list.items;
      return <>
        {shown.length === 0 ? <p class="sec">{q ? `No device has “${q}” in its name, model or serial.` : <>No device yet. <a href="/upload">Upload a recording</a> and it has one.</>}</p> : <div class="scroll"><table class="stacked">
          <thead><tr><th scope="col">device</th><th scope="col">unit</th><th scope="col" class="n">recordings</th><th scope="col">conditions</th><th scope="col">last result</th></tr></thead>
          <tbody>{shown.map(device => <tr key={device.id}>
            <th scope="row"><a href={pageOf('devices', device.name)}>{device.name}</a></th>
            <td class="sec">{[device.model, device.imu].filter(Boolean).join(', ') || '–'}</td>
            <td class="n" data-label="recordings">{device.summary?.recordings ?? '–'}</td>
            <td class="sec">{device.summary?.conditions.slice(0, 4).map(one => conditionName(one.condition)).join(', ')}{(device.summary?.conditions.length ?? 0) > 4 ? ` and ${device.summary!.conditions.length - 4} more` : ''}</td>
            <td class="sec"><LastResult device={device} /></td>
          </tr>)}</tbody></table></div>}
        <Pager next={list.next_cursor} />
      </>;
    }}</Shown></Panel>
  </>;
}
