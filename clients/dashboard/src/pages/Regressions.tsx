// The history of what was asked: is a change of firmware, board or mounting no worse? One row per device and baseline, its runs in a
// strip, and what they say of one parameter against its margin.
import type {JSX} from 'preact';
import {useRead} from '../api/client';
import type {List} from '../api/documents';
import {writeWhen} from '../format/time';
import {plural} from '../format/words';
import {choose, pageOf, usePlace} from '../route';
import {Head} from '../shell/Head';
import {Pager} from '../shell/Pager';
import {Panel, Shown} from '../shell/states';
import {useTitle} from '../shell/title';
import {VERDICT_MARKS, type Regression, type RegressionRun} from './regression/documents';
import {History, parameterName} from './regression/History';

const SHOWN = 50;
const DRAWN = 6;                  // devices and baselines with a figure
const FIRST = 'white_noise.N';    // the parameter that every model of noise has

function Strip({runs}: {runs: readonly RegressionRun[]}): JSX.Element {
  return <span class="run-strip">{runs.slice().reverse().map(run => <a key={run.id} href={pageOf('regressions', run.id)} class={run.verdict === 'fail' ? 'bad' : ''} title={`${run.candidate || 'candidate'}: ${run.verdict ?? run.state}, ${writeWhen(run.created_at)}`} aria-label={`${run.candidate || 'candidate'}: ${run.verdict ?? run.state}`}>{VERDICT_MARKS[run.verdict ?? ''] ?? '·'}</a>)}</span>;
}

function grouped(runs: readonly RegressionRun[]): [string, RegressionRun[]][] {
  const groups = new Map<string, RegressionRun[]>();
  for (const run of runs) {
    const key = `${run.device_name ?? run.device ?? '–'} against ${run.baseline || 'its baseline'}`;
    groups.set(key, [...groups.get(key) ?? [], run]);
  }
  return [...groups];
}

function Runs({groups}: {groups: readonly [string, RegressionRun[]][]}): JSX.Element {
  return <table class="stacked"><thead><tr><th scope="col">device and baseline</th><th scope="col">runs, the last at the right</th><th scope="col">latest candidate</th><th scope="col">what it says</th><th scope="col">when</th></tr></thead>
    <tbody>{groups.map(([key, list]) => { const last = list[0]!; return <tr key={key}>
      <th scope="row">{key}</th><td><Strip runs={list} /></td>
      <td><a href={pageOf('regressions', last.id)}>{last.candidate || 'candidate'}</a>{last.candidate && <> <button type="button" class="quiet" aria-label={`Only ${last.candidate}`} onClick={() => choose({label: last.candidate, after: null})}>only this</button></>}</td>
      <td>{last.summary ? <><span class={`g ${last.verdict === 'fail' ? 'bad' : last.verdict === 'pass' ? 'good' : 'warn'}`} aria-hidden="true">{last.verdict === 'fail' ? '✗ ' : last.verdict === 'pass' ? '✓ ' : '△ '}</span>{last.summary.verdict}</> : last.state}</td>
      <td class="sec nowrap">{writeWhen(last.created_at)}</td></tr>; })}</tbody></table>;
}

export default function Regressions(): JSX.Element {
  const {query} = usePlace();
  useTitle('Regressions');
  const after = query.get('after');
  const label = query.get('label') ?? '';
  const parameter = query.get('param') ?? FIRST;
  const path = `/v1/regressions?sort=-created_at&limit=${SHOWN}&parameter=${encodeURIComponent(parameter)}${label && `&label=${encodeURIComponent(label)}`}${after ? `&cursor=${after}` : ''}`;
  const read = useRead<List<RegressionRun>>(path, 5000);
  // The parameters that can be chosen are those of the newest run that compared some.
  const newest = read.data?.items.find(run => run.verdict !== null)?.id;
  const whole = useRead<Regression>(newest ? `/v1/regressions/${newest}` : null);
  const names = [...new Set([FIRST, parameter, ...(whole.data?.units ?? []).flatMap(unit => unit.tests.flatMap(test => test.kind === 'parameter' && test.name ? [test.name] : []))])];
  const groups = grouped(read.data?.items ?? []);
  return <>
    <Head title="Regressions" facts={['is the noise no worse than before the change?', label ? `candidate ${label}` : '', read.data && plural(read.data.items.length, 'run')]} actions={label && <button type="button" class="btn" onClick={() => choose({label: null, after: null})}>All candidates</button>} />
    <Shown read={read}>{list => list.items.length === 0 && label ? <Panel><p class="sec">No run has the candidate “{label}”.</p></Panel> : list.items.length === 0
      ? <Panel title="None yet"><p>A run compares recordings after a change with recordings before it, and passes, fails or says how many sessions would decide. Ask for one by the command line or by the API:</p>
        <pre tabIndex={0}><code>{`curl --json '{"kind": "regress", "inputs": {"device": "phone-07", "baseline": {"recordings": [{"recording": "rec_…"}]},\n  "candidate": {"recordings": [{"recording": "rec_…"}]}}}' ${window.location.origin}/v1/jobs`}</code></pre><p><a href="/docs/regression">How it is decided</a></p></Panel>
      : <>
        <Panel title="History" sub="● pass ■ fail ○ inconclusive" tools={<div class="tools"><label class="nowrap">parameter <select value={parameter} onChange={event => choose({param: event.currentTarget.value === FIRST ? null : event.currentTarget.value})}>{names.map(name => <option key={name} value={name}>{parameterName(name)}</option>)}</select></label></div>}><Runs groups={groups} />
          <Pager next={list.next_cursor} on={`Next ${SHOWN}`} /></Panel>
        {groups.slice(0, DRAWN).map(([key, runs]) => <History key={key} title={key} parameter={parameter} runs={runs} path={path} />)}
      </>}</Shown>
  </>;
}
