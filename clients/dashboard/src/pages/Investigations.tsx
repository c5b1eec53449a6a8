// Investigations, newest first; and the request for one of a device's recordings.
import type {JSX} from 'preact';
import {useEffect, useState} from 'preact/hooks';
import {Problem, send, useRead} from '../api/client';
import type {Device, Job, List, Recording} from '../api/documents';
import {writeWhen} from '../format/time';
import {conditionName, plural} from '../format/words';
import {choose, go, pageOf, usePlace} from '../route';
import {Head} from '../shell/Head';
import {Pager} from '../shell/Pager';
import {Panel, Refusal, Shown} from '../shell/states';
import {useTitle} from '../shell/title';
import {causeName, type InvestigationRow} from './investigation/documents';

function Ask({device}: {device: string}): JSX.Element {
  const read = useRead<List<Recording>>(`/v1/recordings?device=${encodeURIComponent(device)}&sort=-created_at&limit=50`);
  const [left, setLeft] = useState<string[]>([]);
  const [problem, setProblem] = useState<Problem>();
  const start = async (recordings: Recording[]): Promise<void> => {
    setProblem(undefined);
    try {
      const study = await send<{id: string}>('POST', '/v1/studies', {device: {id: device}, recordings: recordings.map(one => ({recording: one.id}))});
      const job = await send<Job>('POST', '/v1/jobs', {kind: 'investigate', inputs: {study: study.id}});
      go(pageOf('jobs', job.id));
    } catch (error) { setProblem(error as Problem); }
  };
  return <Panel title={`Investigate ${device}`} sub="what a simulation of these recordings gets wrong">
    <Shown read={read}>{list => { const chosen = list.items.filter(one => !left.includes(one.id)); return <>
      <ul class="rows">{list.items.map(one => <li key={one.id}><label><input type="checkbox" checked={!left.includes(one.id)} onChange={() => setLeft(left.includes(one.id) ? left.filter(id => id !== one.id) : [...left, one.id])} /> {one.metadata.id ?? one.id}</label><span class="sec">{conditionName(one.metadata.condition)}</span></li>)}</ul>
      <button type="button" class="btn primary" disabled={chosen.length === 0} onClick={() => void start(chosen)}>Investigate {plural(chosen.length, 'recording')}</button>
      {problem && <Refusal problem={problem} />}
    </>; }}</Shown>
  </Panel>;
}

export default function Investigations(): JSX.Element {
  const {query} = usePlace();
  useTitle('Investigations');
  const device = query.get('device');
  const job = query.get('job');
  const after = query.get('after');
  const read = useRead<List<InvestigationRow>>(`/v1/investigations?sort=-created_at&limit=50${device ? `&device=${encodeURIComponent(device)}` : ''}${job ? `&job=${job}` : ''}${after ? `&cursor=${after}` : ''}`);
  const devices = useRead<List<Device>>('/v1/devices?limit=500');
  const nameOf = (id: string): string => devices.data?.items.find(one => one.id === id)?.name ?? id;
  useEffect(() => { if (job && read.data?.items[0]) go(pageOf('investigations', read.data.items[0].id), {replace: true}); }, [job, read.data]);
  return <>
    <Head title="Investigations" facts={['what simulations get wrong, and why']} actions={device ? <button type="button" class="btn" onClick={() => choose({device: null})}>All devices</button> : undefined} />
    {device && <Ask device={device} />}
    <Panel title={device ? `Of ${device}` : 'Newest first'}><Shown read={read}>{list => list.items.length === 0 ? <p class="sec">None yet. A device’s page asks for one.</p> : <>
      <table class="stacked"><thead><tr><th scope="col">device</th><th scope="col">found</th><th scope="col">when</th></tr></thead><tbody>{list.items.map(row => { const causes = [...new Set(row.findings.map(finding => finding.cause))]; return <tr key={row.id}>
        <th scope="row"><a href={pageOf('investigations', row.id)}>{nameOf(row.device)}</a></th><td class="sec">{causes.length === 0 ? 'nothing' : `${causes.slice(0, 5).map(causeName).join(', ')}${causes.length > 5 ? ` and ${causes.length - 5} more` : ''}`}</td><td class="sec">{writeWhen(row.created_at)}</td></tr>; })}</tbody></table>
      <Pager next={list.next_cursor} /></>}</Shown></Panel>
  </>;
}
