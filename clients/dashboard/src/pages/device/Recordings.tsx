// The recordings of a device, and what can be done with those that are chosen.
import type {JSX} from 'preact';
import {useRef, useState} from 'preact/hooks';
import {Problem, remove, useRead} from '../../api/client';
import type {Attention, Device, List, Recording} from '../../api/documents';
import {writeTick} from '../../format/number';
import {writeDuration, writeWhen} from '../../format/time';
import {conditionName, plural, writeSentence} from '../../format/words';
import {choose, go, pageOf, usePlace} from '../../route';
import {Characterise} from '../../shell/Characterise';
import {Delete} from '../../shell/Delete';
import {copy, curlOf} from '../../shell/copy';
import {say} from '../../shell/say';
import {Pager} from '../../shell/Pager';
import {Panel, Refusal, Shown} from '../../shell/states';
import {qualityWords} from '../Recording';

const PRINTED = 10;  // recordings of a report, as style/print.css says
const COMPARED = 8;  // items of a comparison

const nameOf = (recording: Recording): string => recording.metadata.id ?? recording.id;

// What the newest result of a recording says: the sentence where it must be read. Of the gravest channel where there are several.
function ResultCell({recording, attention}: {recording: Recording; attention: List<Attention> | undefined}): JSX.Element {
  const about = attention?.items.find(one => one.recording === recording.id);
  if (recording.latest_job === null) return <>not characterised</>;
  if (about) return <><span class={`g ${about.level === 'wrong' ? 'bad' : 'warn'}`} aria-hidden="true">{about.level === 'wrong' ? '✗' : '△'} </span>{writeSentence(about.verdict)}</>;
  return <>{attention && !attention.next_cursor ? 'fits' : '…'}</>;
}

// What is chosen stands in the address: Back and reload keep it.
function Chosen({ids, names, onDeleted}: {ids: readonly string[]; names: readonly string[]; onDeleted: () => void}): JSX.Element {
  const [problem, setProblem] = useState<Problem>();
  // One after the other: where one is refused, the rest stays chosen and is not asked for.
  const forget = async (): Promise<void> => {
    let gone = 0;
    setProblem(undefined);
    try {
      for (const id of ids) { await remove(`/v1/recordings/${id}`); ++gone; }
    } catch (error) {
      setProblem(error as Problem);
    }
    if (gone > 0) say(`${plural(gone, 'recording is', 'recordings are')} deleted.`);
    choose({chosen: ids.slice(gone).join(',')});
    onDeleted();
  };
  return <>
    {problem && <Refusal problem={problem} />}
    <div class="chosen" role="group" aria-label="Chosen recordings"><span>{ids.length} chosen</span>
      {ids.length > 1 && ids.length <= COMPARED && <a class="btn" href={`/compare?with=${ids.join(',')}`}>Compare</a>}
      <Characterise recordings={[...ids]} label="Characterise" onQueued={job => go(pageOf('jobs', job.id))} />
      <Delete title={`Delete ${plural(ids.length, 'recording')}?`} onDelete={() => void forget()}>{names.slice(0, COMPARED).join(', ')}{names.length > COMPARED ? ` and ${names.length - COMPARED} more` : ''}: with their files and results.</Delete>
      <button type="button" class="link" onClick={() => choose({chosen: null})}>Choose none</button></div>
  </>;
}

export function Recordings({device, axis}: {device: Device; axis: string | null}): JSX.Element {
  const {query} = usePlace();
  const after = query.get('after');
  const read = useRead<List<Recording>>(`/v1/recordings?device=${device.id}&sort=-created_at&limit=50${after ? `&cursor=${after}` : ''}`);
  const chosen = (query.get('chosen') ?? '').split(',').filter(Boolean);
  const last = useRef('');
  const toggle = (event: MouseEvent, id: string, ids: readonly string[]): void => {
    const to = ids.indexOf(id);
    const from = event.shiftKey && ids.includes(last.current) ? ids.indexOf(last.current) : to;
    const these = ids.slice(Math.min(from, to), Math.max(from, to) + 1);
    last.current = id;
    choose({chosen: (chosen.includes(id) ? chosen.filter(each => !these.includes(each)) : [...chosen, ...these.filter(each => !chosen.includes(each))]).join(',')});
  };
  // What a finger asks by a long press, where a mouse asks for the browser's menu.
  const press = (event: MouseEvent, id: string, ids: readonly string[]): void => {
    if ((event as PointerEvent).pointerType !== 'touch') return;
    event.preventDefault();
    toggle(event, id, ids);
  };
  const attention = useRead<List<Attention>>(`/v1/attention?device=${device.id}&limit=500`);
  return <Panel title="Recordings" sub="newest first" tools={<div class="tools"><button type="button" class="quiet" onClick={() => copy(curlOf(`/v1/recordings?device=${device.id}&sort=-created_at`), 'The command is')}>curl</button></div>}>
    <Shown read={read}>{list => <>
      <div class="scroll"><table class="stacked list-of-recordings">
        <thead><tr><th scope="col" class="no-print"><span class="visually-hidden">Chosen</span></th><th scope="col">recording</th><th scope="col">condition</th><th scope="col" class="n">length</th><th scope="col">quality</th><th scope="col">result</th><th scope="col">uploaded</th></tr></thead>
        <tbody>{list.items.map(recording => <tr key={recording.id} onContextMenu={event => press(event, recording.id, list.items.map(each => each.id))}>
          <td class="no-print pick"><label class="touch"><input type="checkbox" checked={chosen.includes(recording.id)} onClick={event => toggle(event, recording.id, list.items.map(each => each.id))} /><span class="visually-hidden">Choose {nameOf(recording)}</span></label></td>
          <th scope="row"><a href={pageOf('recordings', recording.id)}>{nameOf(recording)}</a></th><td>{conditionName(recording.metadata.condition, axis)}</td>
          <td class="n nowrap" data-label="length">{recording.duration_s === null ? plural(recording.quality.samples, 'sample') : writeDuration(recording.duration_s)}{recording.rate_hz !== null && <span class="dim">, {writeTick(Number(recording.rate_hz.toPrecision(4)))} Hz</span>}</td><td class="sec">{qualityWords(recording)}</td><td class="sec"><ResultCell recording={recording} attention={attention.data} /></td><td class="sec">{writeWhen(recording.created_at)}</td>
        </tr>)}</tbody></table></div>
      {(list.items.length > PRINTED || list.next_cursor) && <p class="print-only note">The newest {PRINTED} of {list.next_cursor ? `more than ${list.items.length}` : list.items.length} recordings; the page has all.</p>}
      <Pager next={list.next_cursor} />
      {chosen.length > 0 && <Chosen ids={chosen} names={chosen.map(id => { const found = list.items.find(each => each.id === id); return found ? nameOf(found) : id; })} onDeleted={read.again} />}
    </>}</Shown>
  </Panel>;
}
