// What runs, what waits, what ran: one clock for all.
import type {JSX} from 'preact';
import {useEffect, useState} from 'preact/hooks';
import {Problem, send, useRead} from '../api/client';
import type {Counts, Job, List} from '../api/documents';
import {writeClock, writeDuration, writeMoment} from '../format/time';
import {capital, jobKind, plural} from '../format/words';
import {choose, pageOf, usePlace} from '../route';
import {Head} from '../shell/Head';
import {Pager} from '../shell/Pager';
import {Panel, Progress, Refusal, Segments, Shown} from '../shell/states';
import {Tabs} from '../shell/Tabs';
import {useTitle} from '../shell/title';

const STATES: Record<string, [string, string]> = {succeeded: ['✓', 'good'], failed: ['✗', 'bad'], dead: ['✗', 'bad'], cancelled: ['–', ''], running: ['●', ''], queued: ['○', '']};
const KINDS = ['characterise', 'investigate', 'outage_evaluation', 'drive_evaluation', 'regress', 'pool'];
const WIDTH = 520;
const SURE_S = 5;

// What a job is about: its scenario or its device, with the recording or how many there are.
export function what(job: Job): string {
  const {inputs, parameters} = job.request;
  if (inputs.scenario !== undefined) return `scenario ${typeof inputs.scenario === 'string' ? inputs.scenario : 'of its own'}${parameters.runs ? `, ${parameters.runs} runs` : ''}`;
  const count = inputs.recordings?.length ?? 0;
  const more = inputs.candidate ? `${inputs.candidate.label || 'candidate'} against ${inputs.baseline?.label || 'the baseline'}`
    : job.kind === 'drive_evaluation' ? `${parameters.question ?? 'run'} ${inputs.document?.id ?? ''}`.trim()
    : count > 0 ? job.recording_name ?? plural(count, 'recording') : inputs.axis ? `axis ${inputs.axis}` : '';
  return [job.device_name, more].filter(Boolean).join(', ') || '–';
}

export function resultPage(job: Job): string {
  if (job.kind === 'characterise' && job.request.inputs.recordings?.[0]) return pageOf('recordings', job.request.inputs.recordings[0].id);
  if (job.kind === 'outage_evaluation') return pageOf('outages', job.id);
  if (job.kind === 'drive_evaluation') return pageOf('drive-evaluations', job.id);
  if (job.kind === 'regress') return pageOf('regressions', job.id);
  if (job.kind === 'investigate') return `/investigations?job=${job.id}`;
  return pageOf('jobs', job.id);
}

export function State({job}: {job: Job}): JSX.Element {
  const [mark, tone] = STATES[job.state] ?? ['', ''];
  return <span class="nowrap"><span class={`g ${tone}`} aria-hidden="true">{mark} </span>{job.cancel_requested && job.state === 'running' ? 'stopping' : job.state}{job.state === 'running' ? `, ${Math.round(job.progress * 100)} %` : ''}</span>;
}

// From the rate of progress, once that can be known; in whole minutes.
export function timeLeft(job: Job): string {
  if (!job.started_at || job.progress <= 0.01) return '';
  const seconds = (Date.now() - Date.parse(job.started_at)) / 1000;
  if (seconds < SURE_S) return '';
  return `about ${Math.ceil(seconds / job.progress * (1 - job.progress) / 60)} min left`;
}

export function Cancel({job, onDone}: {job: Job; onDone: () => void}): JSX.Element | null {
  const [asked, setAsked] = useState(false);
  const [problem, setProblem] = useState<Problem>();
  if (job.finished_at) return null;
  return <>{asked || job.cancel_requested ? <span class="sec">stopping</span> : <button type="button" class="link" onClick={() => {
    setAsked(true);
    send('POST', `/v1/jobs/${job.id}/cancel`).then(onDone, error => { setAsked(false); setProblem(error as Problem); });
  }}>Cancel</button>}{problem && <Refusal problem={problem} />}</>;
}

function Clock({job, from, to}: {job: Job; from: number; to: number}): JSX.Element {
  const x = (time: number): number => Math.round((time - from) / (to - from) * (WIDTH - 8) * 10) / 10 + 4;
  const made = Date.parse(job.created_at);
  const started = job.started_at ? Date.parse(job.started_at) : null;
  const ended = job.finished_at ? Date.parse(job.finished_at) : Date.now();
  return <svg viewBox={`0 0 ${WIDTH} 16`} width="100%" height="16" preserveAspectRatio="none" aria-hidden="true">
    <line x1={x(made)} x2={x(started ?? ended)} y1="8" y2="8" stroke="var(--rule)" stroke-width="1.2" stroke-dasharray="1.5 3" />
    {started !== null && <rect x={x(started)} y="3" width={Math.max(2, x(ended) - x(started))} height="10" rx="1.5" fill={job.finished_at ? 'var(--rule)' : 'var(--ink)'} />}
  </svg>;
}

function useNow(everyMs: number): void {
  const [, again] = useState(0);
  useEffect(() => {
    const timer = setInterval(() => again(n => n + 1), everyMs);
    return () => clearInterval(timer);
  }, [everyMs]);
}

export default function Jobs(): JSX.Element {
  const {query} = usePlace();
  useTitle('Jobs');
  useNow(1000);
  const state = query.get('state') ?? 'all';
  const after = query.get('after');
  const kind = query.get('kind') ?? '';
  const path = `/v1/jobs?sort=-created_at&limit=50${state === 'all' ? '' : `&state=${state}`}${kind && `&kind=${encodeURIComponent(kind)}`}${after ? `&cursor=${after}` : ''}`;
  const read = useRead<List<Job>>(path, 2000);
  const counts = useRead<Counts>(`/v1/counts?since=${new Date().toISOString().slice(0, 10)}T00:00:00Z`, 2000);
  const workers = useRead<{workers: number}>('/v1/workers', 30000);
  const jobs = read.data?.items ?? [];
  const running = jobs.filter(job => job.state === 'running');
  const from = Math.min(...jobs.map(job => Date.parse(job.created_at)));
  const to = Math.max(...jobs.map(job => job.finished_at ? Date.parse(job.finished_at) : Date.now()), from + 1000);
  return <>
    <Head title="Jobs" facts={[counts.data && `${counts.data.jobs.running} running, ${counts.data.jobs.queued} queued, ${counts.data.jobs.failed_since?.count ?? 0} failed today`, workers.data && plural(workers.data.workers, 'worker'), 'live']}
      actions={<><label>kind <select value={kind} onChange={event => choose({kind: event.currentTarget.value || null, after: null})}><option value="">all</option>{KINDS.map(each => <option key={each} value={each}>{jobKind(each)}</option>)}</select></label><Segments label="State" options={[['all', 'All'], ['running', 'Running'], ['failed', 'Failed']] as const} value={state as 'all'} onChange={value => choose({state: value === 'all' ? null : value, after: null})} /></>} />
    <Tabs group="jobs" />
    {running.map(job => <Panel key={job.id} title={<a href={pageOf('jobs', job.id)}>{capital(jobKind(job.kind))}: {what(job)}</a>} sub={`${job.stage ?? 'starting'} · attempt ${job.attempt} · started ${job.started_at ? writeClock(job.started_at) : '–'}`}
      tools={<div class="tools"><Cancel job={job} onDone={read.again} /></div>}>
      <div class="row"><span class="grow"><Progress share={job.progress} label={jobKind(job.kind)} /></span><b>{Math.round(job.progress * 100)} %</b><span class="sec">{timeLeft(job)}</span></div>
    </Panel>)}
    <Panel>
      <Shown read={read}>{() => jobs.length === 0 ? <p class="sec">{state === 'all' && !kind ? 'No job yet. Uploads queue them, and so does every Characterise button.' : `No job${kind && ` of the kind ${jobKind(kind)}`} ${state === 'all' ? 'yet' : `is ${state}`}.`}</p> : <div class="scroll"><table class="stacked">
        <thead><tr><th scope="col">kind</th><th scope="col">what</th><th scope="col">state</th><th scope="col" class="n">took</th><th scope="col" class="desk-only">when <span class="dim">dotted: waiting</span></th><th scope="col"><span class="visually-hidden">Result</span></th></tr></thead>
        <tbody>{jobs.map(job => <tr key={job.id}>
          <th scope="row"><a href={pageOf('jobs', job.id)}>{jobKind(job.kind)}</a></th>
          <td class="sec">{what(job)}{job.problem && <div><span class="g bad" aria-hidden="true">✗ </span>{job.problem.detail}</div>}</td>
          <td><State job={job} /></td>
          <td class="n nowrap" data-label="took">{job.started_at ? writeDuration(((job.finished_at ? Date.parse(job.finished_at) : Date.now()) - Date.parse(job.started_at)) / 1000) : '–'}</td>
          <td class="desk-only" style={{width: '38%'}}><Clock job={job} from={from} to={to} /></td>
          <td class="n">{job.state === 'succeeded' ? <a href={resultPage(job)}>Result</a> : <Cancel job={job} onDone={read.again} />}</td>
        </tr>)}
        <tr class="desk-only axis" aria-hidden="true"><td /><td /><td /><td class="n" /><td><div class="row u" style={{justifyContent: 'space-between'}}><span>{writeMoment(new Date(from).toISOString())}</span><span>{writeClock(new Date(to).toISOString())} UTC</span></div></td><td /></tr>
        </tbody>
      </table></div>}</Shown>
      <Pager next={read.data?.next_cursor} />
    </Panel>
  </>;
}
