// Outage evaluations, newest first, and the form that asks for another.
import type {JSX} from 'preact';
import {useState} from 'preact/hooks';
import {Problem, send, useRead} from '../api/client';
import type {List} from '../api/documents';
import {writeWhen} from '../format/time';
import {go, pageOf, usePlace} from '../route';
import {Head} from '../shell/Head';
import {Pager} from '../shell/Pager';
import {Panel, Refusal, Shown} from '../shell/states';
import {Tabs} from '../shell/Tabs';
import {useTitle} from '../shell/title';
import type {StoredEvaluation} from './outage/documents';

const SCENARIOS = ['paper', 'paper-position-only', 'paper-nhc', 'paper-s-curves'];

export default function Outages(): JSX.Element {
  const {parts, query} = usePlace();
  const alone = parts[1] === 'new';
  const after = query.get('after');
  useTitle('Outages');
  const read = useRead<List<StoredEvaluation>>(`/v1/outage-evaluations?sort=-created_at&limit=50${after ? `&cursor=${after}` : ''}`, 5000);
  const [scenario, setScenario] = useState('paper');
  const [runs, setRuns] = useState('200');
  const [problem, setProblem] = useState<Problem>();
  const start = (): void => { setProblem(undefined); send<StoredEvaluation>('POST', '/v1/outage-evaluations', {scenario, runs: Number(runs)}).then(made => go(pageOf('outages', made.id)), error => setProblem(error as Problem)); };
  return <>
    <Head {...(alone ? {crumb: [['Outages', '/outages'], ['new', null]] as const} : {})} title={alone ? 'Simulate outages' : 'Outages'} facts={['what error models are worth in navigation']} actions={!alone && <a class="btn primary" href="/outages/new">Simulate</a>} />
    {!alone && <Tabs group="outages" />}
    {alone && <Panel title="Scenario">
      <div class="row"><label>scenario <select value={scenario} onChange={event => setScenario(event.currentTarget.value)}>{SCENARIOS.map(name => <option key={name}>{name}</option>)}</select></label>
        <label>runs <input type="number" min={2} max={100000} value={runs} onInput={event => setRuns(event.currentTarget.value)} /></label><button type="button" class="btn primary" onClick={start}>Simulate</button></div>
      {problem && <Refusal problem={problem} />}
      <p class="note">200 runs take about three minutes. A scenario of your own goes in by <a href="/docs/navigation">the API</a>.</p>
    </Panel>}
    {!alone && <Panel title="Evaluations" sub="newest first"><Shown read={read}>{list => list.items.length === 0 ? <p class="sec">None yet. The scenario “paper” simulates the drive of Radi et al. (2017) with four outages.</p> : <><table class="stacked">
      <thead><tr><th scope="col">scenario</th><th scope="col" class="n">runs</th><th scope="col">state</th><th scope="col">when</th></tr></thead>
      <tbody>{list.items.map(each => <tr key={each.id}><th scope="row"><a href={pageOf('outages', each.id)}>{each.scenario_name}</a></th><td class="n" data-label="runs">{each.runs}</td><td>{each.state}{each.finished_at ? '' : `, ${Math.round(each.progress * 100)} %`}</td><td class="sec">{writeWhen(each.created_at)}</td></tr>)}</tbody></table><Pager next={list.next_cursor} /></>}</Shown></Panel>}
  </>;
}
