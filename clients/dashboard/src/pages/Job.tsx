// One job: how it goes, what was asked for, how often it was tried.
import type {JSX} from 'preact';
import {useState} from 'preact/hooks';
import {Problem, send, useJobEvents, useRead} from '../api/client';
import type {Job} from '../api/documents';
import {writeDuration, writeFull} from '../format/time';
import {capital, jobKind} from '../format/words';
import {go, pageOf, usePlace} from '../route';
import {Head} from '../shell/Head';
import {copy} from '../shell/copy';
import {Panel, Progress, Refusal, Shown} from '../shell/states';
import {useTitle} from '../shell/title';
import {asked} from './job/asked';
import {Events} from './job/Events';
import {Cancel, resultPage, timeLeft, what} from './Jobs';

function sentence(job: Job): string {
  const took = job.started_at && job.finished_at ? writeDuration((Date.parse(job.finished_at) - Date.parse(job.started_at)) / 1000) : '';
  switch (job.state) {
    case 'succeeded': return `Ended after ${took}.`;
    case 'running': return `${capital(job.stage ?? 'starting')}, ${Math.round(job.progress * 100)} %. ${timeLeft(job)}`;
    case 'queued': return 'Waits for a worker.';
    case 'cancelled': return 'Cancelled; nothing of it was stored.';
    default: return job.problem?.detail ?? 'Failed.';
  }
}

export default function JobPage(): JSX.Element {
  const {parts} = usePlace();
  const read = useRead<Job>(`/v1/jobs/${encodeURIComponent(parts[1] ?? '')}`);
  const live = read.data && !read.data.finished_at ? read.data.id : null;
  useJobEvents(live, read.again);
  const [problem, setProblem] = useState<Problem>();
  useTitle(read.data ? capital(jobKind(read.data.kind)) : 'Job');
  return <Shown read={read} page="Job">{job => {
    const request = JSON.stringify(asked(job), null, 2);
    const command = `curl -X POST -H 'Content-Type: application/json' -d '${JSON.stringify(asked(job))}' '${window.location.origin}/v1/jobs'`;
    return <>
      <Head crumb={[['Jobs', '/jobs'], [job.id, null]]} title={`${capital(jobKind(job.kind))}: ${what(job)}`} facts={[job.state, `attempt ${job.attempt}`, `queued ${writeFull(job.created_at)}`]}
        actions={<>{job.state === 'succeeded' && job.kind !== 'pool' && <a class="btn primary" href={resultPage(job)}>Result</a>}
          {['failed', 'dead', 'cancelled'].includes(job.state) && <button type="button" class="btn primary" onClick={() => send<Job>('POST', '/v1/jobs', asked(job)).then(next => go(pageOf('jobs', next.id)), error => setProblem(error as Problem))}>Run again</button>}
          {job.finished_at && job.kind !== 'pool' && <a class="btn" href={`/jobs/new?like=${job.id}`}>Run again with other settings</a>}
          <Cancel job={job} onDone={read.again} /></>} />
      <p class="verdict" role="status">{job.problem && <span class="g bad" aria-hidden="true">✗ </span>}{sentence(job)}</p>
      {problem && <Refusal problem={problem} />}
      {!job.finished_at && <Progress share={job.progress} label={jobKind(job.kind)} />}
      <div class="grid two">
        <Panel title="Asked for" tools={<div class="tools"><button type="button" class="quiet" onClick={() => copy(command, 'The command is')}>curl</button></div>}><pre tabIndex={0}>{request}</pre></Panel>
        <Panel title="Attempts">
          {job.failed_attempts.length === 0 ? <p class="sec">{job.attempt === 0 ? 'Not started yet.' : 'No attempt failed.'}</p>
            : <ol class="rows">{job.failed_attempts.map((each, i) => <li key={i}><span class="g bad" aria-hidden="true">✗</span>{each.detail}</li>)}</ol>}
          <table class="params"><tbody>
            <tr><th scope="row">queued</th><td>{writeFull(job.created_at)}</td></tr>
            {job.started_at && <tr><th scope="row">started</th><td>{writeFull(job.started_at)}</td></tr>}
            {job.finished_at && <tr><th scope="row">ended</th><td>{writeFull(job.finished_at)}</td></tr>}
            <tr><th scope="row">algorithm</th><td>version {job.request.algorithm_version}</td></tr>
          </tbody></table>
        </Panel>
      </div>
      {job.finished_at && <Events job={job.id} />}
    </>;
  }}</Shown>;
}
