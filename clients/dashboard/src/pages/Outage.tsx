// What error models are worth in navigation: error, gain, honesty.
import type {JSX} from 'preact';
import {useJobEvents, useRead} from '../api/client';
import {writeDuration, writeWhen} from '../format/time';
import {capital, plural, writeSentence} from '../format/words';
import {Drawn} from '../figure/Drawn';
import type {Table} from '../figure/export';
import {choose, usePlace} from '../route';
import {RunAgain} from '../shell/Again';
import {Head, Verdict} from '../shell/Head';
import {usePageKeys} from '../shell/keys';
import {MadeBy, Report} from '../shell/Report';
import {curlOf} from '../shell/copy';
import {Panel, Progress, Segments, Shown} from '../shell/states';
import {useTitle} from '../shell/title';
import type {Evaluation, Filter, Partial, StoredEvaluation} from './outage/documents';
import {Errors} from './outage/Errors';
import {Frame, reachOf} from './outage/Frames';
import {DriveMap} from './outage/Map';
import {Nees} from './outage/Nees';
import {Staircase, stepsOf} from './outage/Staircase';

const driveTable = ({trajectory}: Evaluation): Table => ({heading: ['time s', 'north m', 'east m'], rows: trajectory.time_s.map((time, i) => [time, trajectory.north_m[i] ?? null, trajectory.east_m[i] ?? null])});
const endTable = (filters: readonly Filter[], outage: number): Table => ({heading: ['filter', 'run', 'north m', 'east m'], rows: filters.flatMap(filter => filter.outages[outage]!.errors.north_m.map((north, i) => [filter.name, i + 1, north, filter.outages[outage]!.errors.east_m[i] ?? null]))});
const errorTable = (filters: readonly Filter[]): Table => ({heading: ['filter', 'outage', 'error m', 'low m', 'high m'], rows: filters.flatMap(filter => [{index: 'all', error_m: filter.mean_error_m}, ...filter.outages].map(one => [filter.name, one.index, one.error_m.value, one.error_m.ci95?.[0] ?? null, one.error_m.ci95?.[1] ?? null]))});
const neesTable = (filters: readonly Filter[]): Table => ({heading: ['filter', 'outage', 'NEES', 'low', 'high', 'held by the 95 % ellipse'], rows: filters.flatMap(filter => [{index: 'all', nees: filter.nees, nees_ci95: filter.nees_ci95, coverage95: filter.coverage95}, ...filter.outages].map(one => [filter.name, one.index, one.nees, one.nees_ci95[0] ?? null, one.nees_ci95[1] ?? null, one.coverage95]))});
const gainTable = (evaluation: Evaluation): Table => ({heading: ['step', 'difference m', 'low m', 'high m'], rows: stepsOf(evaluation).map(({name, pair}) => [name, pair.difference_m.value, pair.difference_m.ci95?.[0] ?? null, pair.difference_m.ci95?.[1] ?? null])});

function Found({stored, evaluation}: {stored: StoredEvaluation; evaluation: Evaluation}): JSX.Element {
  const {query} = usePlace();
  const ranked = [...evaluation.filters].sort((a, b) => (a.mean_error_m.value ?? 0) - (b.mean_error_m.value ?? 0));
  const named = (name: string | null, otherwise: Filter): Filter => evaluation.filters.find(filter => filter.name === name) ?? otherwise;
  const left = named(query.get('left'), evaluation.filters.find(filter => filter.name === 'M_stat(AV)') ?? ranked[ranked.length - 1]!);
  const right = named(query.get('right'), ranked[0]!);
  const count = left.outages.length;
  const outage = Math.min(Math.max(Number(query.get('outage') ?? 1), 1), count) - 1;
  const step = (by: number): void => choose({outage: String((outage + by + count) % count + 1)});
  usePageKeys({'[': () => step(-1), ']': () => step(1)});
  const colours = ranked.map(filter => filter === right ? 'var(--model)' : filter === left ? 'var(--robust)' : 'var(--measured)');
  const reach = reachOf([left, right], outage);
  const common = {source: `driftlab, ${stored.id}, algorithm ${evaluation.algorithm_version}, seed ${evaluation.seed}`, curl: curlOf(`/v1/outage-evaluations/${stored.id}`)};
  const start = evaluation.filters.find(filter => filter.name === evaluation.attribution?.total.against);
  const choice = (side: 'left' | 'right', value: Filter): JSX.Element => <label class="nowrap">{side} <select value={value.name} onChange={event => choose({[side]: event.currentTarget.value})}>{evaluation.filters.map(filter => <option key={filter.name}>{filter.name}</option>)}</select></label>;
  return <>
    {evaluation.summary && <Verdict summary={evaluation.summary} />}
    <div class="grid side-main">
      <Drawn {...common} name="outage-drive" title="Drive" sub={`${writeDuration(evaluation.trajectory.time_s[evaluation.trajectory.time_s.length - 1] ?? 0)}, outage ${outage + 1} enlarged`} table={() => driveTable(evaluation)}><DriveMap evaluation={evaluation} outage={outage} left={left} right={right} /></Drawn>
      <Drawn {...common} name={`outage-${outage + 1}-end`} title={`Outage ${outage + 1}, end`} controls={<Segments label="Outage" options={left.outages.map(one => [String(one.index), String(one.index)] as const)} value={String(outage + 1)} onChange={value => choose({outage: value})} />} sub={<>{evaluation.runs} runs · solid: the filter’s own 95 %, dashed: what happened</>}
        more={<div class="tools">{choice('left', left)}{choice('right', right)}</div>} table={() => endTable([left, right], outage)} note="Cross at the true position, north up.">
        <div class="grid two no-top"><Frame filter={left} outage={outage} reach={reach} colour="var(--robust)" /><Frame filter={right} outage={outage} reach={reach} colour="var(--model)" /></div>
      </Drawn>
    </div>
    <div class="grid wide-side">
      <Drawn {...common} name="outage-errors" title="Horizontal error by filter" sub="mean over runs, 95 %" table={() => errorTable(ranked)} how={() => <><p>Every filter sees the same simulated drives. The error is that of the horizontal position at the end of an outage. <a href="/docs/navigation">The manual</a> describes scenario, filters and intervals. Seed {evaluation.seed}, algorithm {evaluation.algorithm_version}.</p><RunAgain job={stored.id} /></>}><Errors filters={ranked} colours={colours} /></Drawn>
      <Drawn {...common} name="outage-nees" title="Does the filter know" sub="NEES, 2 is honest: ● mean, ○ each outage" table={() => neesTable(ranked)}><Nees filters={ranked} colours={colours} /></Drawn>
    </div>
    <div class="grid wide-side">
      {start ? <Drawn {...common} name="outage-gain" title="Where the gain comes from" sub="paired differences, same data for every filter" table={() => gainTable(evaluation)} note="Intervals are of the paired difference, so they are far narrower than those of the errors themselves."><Staircase evaluation={evaluation} from={start} /></Drawn>
        : <Panel title="Where the gain comes from"><p class="sec">The scenario lacks the filters between which the gain could be shared out.</p></Panel>}
      {evaluation.claims.length > 0 && <Panel title="What the paper claims" sub={`${evaluation.claims.filter(claim => claim.supported).length} of ${evaluation.claims.length} supported`}><ul class="rows">{evaluation.claims.map(claim => <li key={claim.claim}><span class="nowrap"><span class={`g ${claim.supported ? 'good' : 'bad'}`} aria-hidden="true">{claim.supported ? '✓' : '✗'} </span><b>{claim.supported ? 'supported' : 'not supported'}</b></span><span class="grow">{claim.claim}<div class="u">{writeSentence(claim.because)}</div></span></li>)}</ul></Panel>}
    </div>
  </>;
}

// Intervals tighten as runs come in; the best filter so far stands first.
function SoFar({partial}: {partial: Partial}): JSX.Element {
  const filters = partial.filters.map(({name, error_m: error}) => ({name, mean_error_m: error, outages: []})).sort((a, b) => (a.mean_error_m.value ?? 0) - (b.mean_error_m.value ?? 0));
  return <Panel title="Horizontal error so far" sub="mean, 95 %"><Errors filters={filters} colours={filters.map(() => 'var(--measured)')} /></Panel>;
}

export default function OutagePage(): JSX.Element {
  const {parts} = usePlace();
  const read = useRead<StoredEvaluation>(`/v1/outage-evaluations/${encodeURIComponent(parts[1] ?? '')}`);
  useJobEvents(read.data && !read.data.finished_at ? read.data.id : null, read.again);
  useTitle(read.data ? `Outages: ${read.data.scenario_name}` : 'Outages');
  return <Shown read={read} page="Outages">{stored => <>
    <Head crumb={[['Outages', '/outages'], [stored.scenario_name, null]]} title={`Simulated outages: ${stored.scenario_name}`}
      facts={[stored.evaluation && plural(stored.evaluation.filters[0]?.outages.length ?? 0, 'outage'), stored.evaluation && plural(stored.evaluation.filters.length, 'filter'), `${plural(stored.evaluation?.runs ?? stored.runs, 'run')}, seed ${stored.seed}`, stored.finished_at ? `${writeWhen(stored.finished_at)}, took ${writeDuration((Date.parse(stored.finished_at) - Date.parse(stored.created_at)) / 1000)}` : stored.state]} actions={<><a class="btn" href={`/jobs/${stored.id}`}>Job</a><Report /></>} />
    <MadeBy job={stored.id} document={`/v1/outage-evaluations/${stored.id}`} />
    {stored.evaluation ? <Found stored={stored} evaluation={stored.evaluation} /> : <><p class="verdict" role="status">{stored.problem ? <><span class="g bad" aria-hidden="true">✗ </span>{stored.problem.detail} {stored.problem.type && <a href={stored.problem.type}>{stored.problem.title}</a>}</> : stored.finished_at ? `The job was ${stored.state}; there is no result.` : stored.partial ? `Running: what ${plural(stored.partial.runs, 'run')} of ${stored.runs} say.` : `${capital(stored.stage ?? 'waiting for a worker')}, ${Math.round(stored.progress * 100)} %`}</p>{!stored.finished_at && <Progress share={stored.progress} label="Outages" />}{!stored.finished_at && stored.partial && <SoFar partial={stored.partial} />}</>}
  </>}</Shown>;
}
