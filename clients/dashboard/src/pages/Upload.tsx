// Upload: drop, columns, condition, and the job that follows.
import type {JSX} from 'preact';
import {useEffect, useState} from 'preact/hooks';
import type {Problem} from '../api/client';
import {writeBytes, writeTick} from '../format/number';
import {countWord, plural, writeSentence} from '../format/words';
import {choose, pageOf, usePlace} from '../route';
import {droppedOf} from '../shell/drops';
import {Head} from '../shell/Head';
import {copy} from '../shell/copy';
import {Panel, Progress, Refusal} from '../shell/states';
import {useTitle} from '../shell/title';
import {Columns} from './upload/Columns';
import {ConditionField} from './upload/ConditionField';
import {DropZone, filesOf} from './upload/DropZone';
import {change, isUnclear, remove, toSend, usePending, type Pending} from './upload/pending';
import {Repair} from './upload/Repair';
import {following, pause, runSample, sendAll, sendOne, take, takeHanded, takeSample} from './upload/run';
import {commandOf} from './upload/send';

// What is known of a file that waits: what would refuse it stands beside the field that mends it.
function Seen({each}: {each: Pending}): JSX.Element {
  const seen = each.look?.document;
  const problem = seen?.problems[0];
  if (problem) return <><span class="g bad" aria-hidden="true">✗ </span>{writeSentence(problem.detail)} <Repair each={each} code={problem.code} detail={problem.detail} fields={problem.fields} /></>;
  const count = seen?.columns.length ?? 0;
  return <span class="sec">{!each.look ? 'reading' : count > 0 ? <><span class="g good" aria-hidden="true">✓ </span>{plural(count, 'column')} read</> : 'ready'}</span>;
}

function Row({each, chosen}: {each: Pending; chosen: boolean}): JSX.Element {
  const name = each.file.name;
  const rate = each.look?.document?.rate_hz;
  const byTime = rate?.from === 'time_column' ? rate : null;
  const text = (field: 'device' | 'rate', label: string, size: number, placeholder = ''): JSX.Element =>
    <input type="text" aria-label={`${label} of ${name}`} size={size} placeholder={placeholder} value={each[field]} disabled={each.state === 'sending' || each.state === 'sent'} onInput={event => change(each.key, {[field]: event.currentTarget.value})} />;
  return <tr aria-selected={chosen}>
    <th scope="row"><button type="button" class="link" onClick={() => choose({file: String(each.key)})}>{name}</button></th>
    <td data-label="device">{text('device', 'Device', 16)}</td>
    <td data-label="condition"><ConditionField label={`Condition of ${name}`} value={each.condition} onChange={condition => change(each.key, {condition})} /></td>
    <td class="n nowrap" data-label="size">{writeBytes(each.file.size)}</td>
    <td class="n" data-label="rate, Hz">{text('rate', 'Rate in Hz', 7, byTime ? writeTick(Number(byTime.value.toPrecision(4))) : 'by time')}</td>
    <td>
      {each.state === 'ready' && <Seen each={each} />}
      {each.state === 'sending' && <><Progress share={each.share} label={`Uploading ${name}`} /><span class="sec">{writeBytes(each.share * each.file.size)} of {writeBytes(each.file.size)} <button type="button" class="link" aria-label={`Pause ${name}`} onClick={() => pause(each.key)}>Pause</button></span></>}
      {each.state === 'paused' && <span class="sec">paused at {writeBytes(each.share * each.file.size)} of {writeBytes(each.file.size)} <button type="button" class="link" aria-label={`Go on with ${name}`} onClick={() => { void sendOne(each); }}>Go on</button></span>}
      {each.state === 'sent' && <><span class="g good" aria-hidden="true">✓ </span><a href={pageOf('recordings', each.recording ?? '')}>stored</a>{each.job && <>, <a href={pageOf('jobs', each.job)}>characterising</a></>}</>}
      {each.state === 'refused' && each.problem && <><Refusal problem={each.problem} />
        <Repair each={each} code={each.problem.document.code ?? ''} detail={each.problem.document.detail} fields={each.problem.document.where ?? {}} />
        <button type="button" class="link" onClick={() => choose({file: String(each.key)})}>What the columns mean</button></>}
    </td>
    <td class="n"><button type="button" class="quiet" aria-label={`Remove ${name}`} onClick={() => remove(each.key)}>Remove</button></td>
  </tr>;
}

export default function Upload(): JSX.Element {
  const files = usePending();
  const {query} = usePlace();
  const [analyse, setAnalyse] = useState(true);
  const [busy, setBusy] = useState(false);
  const [problem, setProblem] = useState<Problem>();
  useTitle('Upload');
  const received = (dropped: readonly File[]): void => { setProblem(undefined); take(dropped).catch(error => setProblem(error as Problem)); };
  useEffect(() => {
    const over = (event: DragEvent): void => event.preventDefault();
    const drop = (event: DragEvent): void => { if (!event.defaultPrevented && event.dataTransfer) { event.preventDefault(); void filesOf(droppedOf(event.dataTransfer)).then(received); } };
    document.addEventListener('dragover', over);
    document.addEventListener('drop', drop);
    return () => { document.removeEventListener('dragover', over); document.removeEventListener('drop', drop); };
  }, []);
  const chosen = files.find(each => String(each.key) === query.get('file')) ?? files.find(each => each.state === 'refused') ?? files[0];
  const open = toSend(files);
  const unclear = files.filter(isUnclear).length;
  const count = (state: Pending['state']): number => files.filter(each => each.state === state).length;
  const states = [[count('ready') - unclear, 'ready'], [unclear, unclear === 1 ? 'needs an answer' : 'need an answer'], [count('sending'), 'uploading'], [count('paused'), 'paused'], [count('sent'), 'stored'], [count('refused'), 'refused']] as const;
  const run = (work: () => Promise<void>): void => {
    setBusy(true);
    setProblem(undefined);
    work().catch(error => setProblem(error as Problem)).finally(() => setBusy(false));
  };
  useEffect(() => { if (takeSample()) run(runSample); const files = takeHanded(); if (files.length > 0) received(files); }, []);
  return <>
    <Head title="Upload" facts={[]} />
    <DropZone onFiles={received} onSample={() => run(runSample)} />
    {problem && <Panel><Refusal problem={problem} /></Panel>}
    {files.length > 0 && <Panel title={`${files.length} file${files.length === 1 ? '' : 's'}`} sub={states.flatMap(([n, word]) => n > 0 ? `${n} ${word}` : []).join(', ')}
      tools={<label class="right"><input type="checkbox" checked={analyse} onChange={() => setAnalyse(!analyse)} /> {following()} when uploaded</label>}>
      <div class="scroll"><table class="files stacked">
        <thead><tr><th scope="col">file</th><th scope="col">device</th><th scope="col">condition</th><th scope="col" class="n">size</th><th scope="col" class="n">rate, Hz</th><th scope="col">state</th><th scope="col"><span class="visually-hidden">Remove</span></th></tr></thead>
        <tbody>{files.map(each => <Row key={each.key} each={each} chosen={each === chosen} />)}</tbody>
      </table></div>
    </Panel>}
    {chosen && <Columns each={chosen} />}
    {open.length > 0 && <div class="row" style={{marginTop: '16px'}}>
      <button type="button" class="btn primary" disabled={busy} onClick={() => run(() => sendAll(analyse))}>Upload {files.length === 1 ? '' : countWord(open.length)}{analyse ? ` and ${following()}` : ''}</button>
      {analyse && <button type="button" class="btn" disabled={busy} onClick={() => run(() => sendAll(false))}>Upload only</button>}
    </div>}
    {chosen && chosen.state !== 'sent' && <p class="note">The same as a command: <code>{commandOf(chosen)}</code> <button type="button" class="link" onClick={() => copy(commandOf(chosen), 'The command is')}>Copy</button></p>}
  </>;
}
