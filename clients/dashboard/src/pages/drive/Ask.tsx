// What is asked of a drive: measured outages, the same simulated, or why the two differ.
import type {JSX} from 'preact';
import {useState} from 'preact/hooks';
import {Problem, send} from '../../api/client';
import {go, pageOf} from '../../route';
import {Panel, Refusal} from '../../shell/states';
import {QUESTIONS, type EvaluationRow, type Question, type StoredDrive} from './documents';

export function Ask({drive}: {drive: StoredDrive}): JSX.Element {
  const [question, setQuestion] = useState<Question>('simulate');
  const [runs, setRuns] = useState('4');
  const [nose, setNose] = useState(false);
  const [rest, setRest] = useState(false);
  const [odometer, setOdometer] = useState(false);
  const [problem, setProblem] = useState<Problem>();
  const explains = question === 'explain';
  const start = (): void => {
    setProblem(undefined);
    send<EvaluationRow>('POST', '/v1/drive-evaluations', {drive: drive.id, question, ...(question === 'run' ? {} : {runs: Number(runs)}), ...(nose ? {velocity_constraint: true} : {}), ...(rest && !explains ? {zero_velocity: true} : {}), ...(odometer && !explains ? {odometer: true} : {})})
      .then(made => go(pageOf('drive-evaluations', made.id)), error => setProblem(error as Problem));
  };
  return <Panel title="Ask">
    <div class="row">
      <label>question <select value={question} onChange={event => setQuestion(event.currentTarget.value as Question)}>{Object.entries(QUESTIONS).map(([key, text]) => <option key={key} value={key}>{text}</option>)}</select></label>
      {question !== 'run' && <label>simulated drives <input type="number" min={1} max={1000} value={runs} onInput={event => setRuns(event.currentTarget.value)} /></label>}
    </div>
    <div class="row">
      <label><input type="checkbox" checked={nose} onChange={() => setNose(!nose)} /> it moves along its nose</label>
      {!explains && <label><input type="checkbox" checked={rest} onChange={() => setRest(!rest)} /> no motion at rest</label>}
      {!explains && drive.drive.odometer && <label><input type="checkbox" checked={odometer} onChange={() => setOdometer(!odometer)} /> use the odometer</label>}
      <button type="button" class="btn primary right" onClick={start}>Ask</button>
    </div>
    {problem && <Refusal problem={problem} />}
    <p class="note">Models and outages of your own go in by <a href="/docs/drives">the API</a>.</p>
  </Panel>;
}
