// One regression run, for whoever wants to know why the gate failed: the sentence, what moved, what else changed, what would decide.
import type {JSX} from 'preact';
import {useMemo} from 'preact/hooks';
import {ask, useJobEvents, useRead} from '../api/client';
import type {Job, List, Nullable, Recording} from '../api/documents';
import {writeNumber, writeP, writeQuantity, writeTick, type Written} from '../format/number';
import {writeDuration} from '../format/time';
import {conditionName, plural, writeSentence, writeUnit} from '../format/words';
import {defaultReadout, Figure} from '../figure/Figure';
import type {Plot, Series} from '../figure/spec';
import {choose, pageOf, usePlace} from '../route';
import {RunAgain} from '../shell/Again';
import {Head, Verdict} from '../shell/Head';
import {MadeBy, Report} from '../shell/Report';
import {say} from '../shell/say';
import {copy, curlOf} from '../shell/copy';
import {Hairlines, Panel, Progress, Refusal, Segments} from '../shell/states';
import {useTitle} from '../shell/title';
import {Accept} from './regression/Accept';
import type {Regression as Document, RegressionRun, Test, Unit} from './regression/documents';
import {axisName, History, parameterName} from './regression/History';

const COLOURS: Record<string, string> = {beyond: 'var(--robust)', worse_within_margin: 'var(--measured)', open: 'var(--measured)', ok: 'var(--measured)', improved: 'var(--model)'};
const WORDS: Record<string, string> = {ok: 'no worse', worse_within_margin: 'worse, within the margin', beyond: 'beyond the margin', open: 'open', improved: 'better'};

// Both arms over each other: the baseline as a line with its band, the candidate as points. Runs of before arms were told have none.
function armsPlot(scales: readonly Test[]): Plot[] {
  const arm = (name: 'baseline' | 'candidate'): Series => {
    const [value, low, high] = [scales.map(test => test[name]?.value ?? null), ...([0, 1] as const).map(i => scales.map(test => test[name]?.ci95?.[i] ?? null))];
    return {id: name, name, x: scales.map(test => test.tau_s!), y: value!, low: low!, high: high!, colour: 'var(--measured)', ...(name === 'baseline' ? {line: true, band: 'var(--band)'} : {mark: 'dot' as const, detail: '95 % interval'})};
  };
  const unit = scales[0]?.candidate?.unit;
  return unit ? [{id: 'arms', height: 220, x: {scale: 'log', name: ''}, y: {scale: 'log', name: `Allan deviation, ${writeUnit(unit)}`}, hideX: true, series: [arm('candidate'), arm('baseline')]}] : [];
}

function ratioPlots(tests: readonly Test[]): Plot[] {
  const scales = tests.filter(test => test.kind === 'scale' && test.tau_s !== undefined);
  const x = scales.map(test => test.tau_s!);
  const ends = (i: 0 | 1): Nullable => scales.map(test => test.ci[i] ?? null);
  // `open`: the interval reaches beyond the margin and back, for want of sessions or of length.
  const kinds = [...new Set(scales.map(test => test.verdict))];
  const series: Series[] = kinds.map(kind => ({id: kind, name: WORDS[kind] ?? kind, ...(kind === 'open' ? {detail: 'too few or too short'} : {}), x, y: scales.map(test => test.verdict === kind ? test.ratio : null), low: ends(0), high: ends(1), mark: kind === 'beyond' ? 'square' : kind === 'open' ? 'open' : 'dot', colour: COLOURS[kind] ?? 'var(--measured)'}));
  // Each averaging time has its own margin; those that are not gated have none.
  const limit: Series = {id: 'margin', name: 'margin', detail: 'of the gated times', x, y: scales.map(test => test.gated ? test.margin : null), line: true, colour: 'var(--robust)', dash: '7 4'};
  return [...armsPlot(scales), {id: 'ratio', height: 220, x: {scale: 'log', name: 'averaging time τ, s'}, y: {scale: 'log', name: 'candidate ÷ baseline, Allan deviation', write: writeTick}, rules: [1], series: [...series, limit]}];
}

const ratioOf = (test: Test): Written => writeQuantity({value: test.ratio, ci95: [test.ci[0] ?? null, test.ci[1] ?? null], unit: ''});

function Tests({unit}: {unit: Unit}): JSX.Element {
  const chosen = usePlace().query.get('param');
  const parameters = unit.tests.filter(test => test.kind === 'parameter');
  return <Panel title="Parameters" sub={unit.structure.changed ? 'not compared: no model describes both arms' : unit.structure.pooled ?? ''}>
    {parameters.length === 0 ? <p class="sec">None is compared; the scales decide.</p> : <table class="stacked"><thead><tr><th scope="col">parameter</th><th scope="col" class="n">candidate ÷ baseline</th><th scope="col">interval</th><th scope="col" class="n">margin</th><th scope="col">word</th></tr></thead>
      <tbody>{parameters.map(test => <tr key={test.name} aria-selected={test.name === chosen}><th scope="row"><button type="button" class="link" aria-pressed={test.name === chosen} onClick={() => choose({param: test.name === chosen ? null : test.name})}>{parameterName(test.name ?? '')}</button></th><td class="n" data-label="candidate ÷ baseline"><b>{ratioOf(test).value}</b></td><td class="ci">{ratioOf(test).interval}</td><td class="n nowrap" data-label="margin">{Math.round((test.margin - 1) * 100)} %</td><td>{test.verdict === 'beyond' && <span class="g bad" aria-hidden="true">✗ </span>}{WORDS[test.verdict] ?? test.verdict}</td></tr>)}</tbody></table>}
    {parameters.filter(test => test.name === chosen).map(test => <p key={test.name} class="note">{parameterName(test.name ?? '')} is {ratioOf(test).value} times that of the baseline{ratioOf(test).interval && `, 95 % ${ratioOf(test).interval}`}: {WORDS[test.verdict] ?? test.verdict}. {Math.round((test.margin - 1) * 100)} % more would be tolerated{test.p_adjusted !== undefined && test.p_adjusted !== null ? `; ${writeP(test.p_adjusted)} after correction for all tests` : ''}.</p>)}
    <p class="note">Structure: {unit.structure.baseline ?? '…'} before, {unit.structure.candidate ?? '…'} after{unit.structure.p !== undefined && unit.structure.p !== null ? `, ${writeP(unit.structure.p)}` : ''}.</p>
  </Panel>;
}

// The runs of this device against the same baseline, one parameter at a time: the one chosen, or white noise, which every model has.
const FIRST = 'white_noise.N';
function Strip({document}: {document: Document}): JSX.Element | null {
  const parameter = usePlace().query.get('param') ?? FIRST;
  const path = `/v1/regressions?device=${encodeURIComponent(document.device)}&parameter=${encodeURIComponent(parameter)}&sort=-created_at&limit=50`;
  const runs = useRead<List<RegressionRun>>(path).data?.items.filter(run => run.baseline === document.arms.baseline.label) ?? [];
  return <History title={`the runs against ${document.arms.baseline.label || 'this baseline'}`} parameter={parameter} runs={runs} path={path} />;
}

// A recording by its name; by its id until that is known, or where it is gone.
function RecordingLink({id}: {id: string}): JSX.Element {
  const read = useRead<Recording>(`/v1/recordings/${id}`);
  return <><a href={pageOf('recordings', id)}>{read.data?.metadata.id ?? id}</a>{read.data && <span class="sec"> {conditionName(read.data.metadata.condition)}{read.data.duration_s !== null && `, ${writeDuration(read.data.duration_s)}`}</span>}</>;
}

function Shown({document, id}: {document: Document; id: string}): JSX.Element {
  const {query} = usePlace();
  const wanted = Number(query.get('unit') ?? 0);
  const unit = document.units[wanted] ?? document.units[0];
  const plots = useMemo(() => unit ? ratioPlots(unit.tests) : [], [unit]);
  const path = `/v1/regressions/${id}`;
  const recordings = [...document.arms.baseline.sessions, ...document.arms.candidate.sessions].flatMap(session => session.recordings);
  return <>
    <Verdict summary={document.summary} />
    {document.needs?.sentence && !document.summary.details.includes(document.needs.sentence) && <p class="note"><b>What would decide:</b> {document.needs.sentence}</p>}
    {document.units.length > 1 && <Segments label="Axis" options={document.units.map((each, i) => [String(i), axisName(each)] as const)} value={String(document.units.indexOf(unit!))} onChange={value => choose({unit: value === '0' ? null : value})} />}
    {unit && <div class="grid wide-side">
      <Figure name={`regression-${document.device}-${unit.axis}`} title={`Allan deviation, ${axisName(unit)}`} describe={`Baseline and candidate over each other; below, candidate over baseline at each averaging time with simultaneous intervals; ${unit.tests.filter(test => test.verdict === 'beyond').length} beyond the margin.`} plots={plots}
        readout={x => <><b>τ {writeNumber(x, 4)} s</b>{plots.map(plot => <span key={plot.id}>{defaultReadout(plot, x)}</span>)}</>} source={`driftlab, ${id}, algorithm ${document.algorithm_version}`} curl={curlOf(path)}
        how={() => <><p>Every averaging time up to {writeDuration(document.scope_s)} and every shared parameter is tested at once: the intervals hold for all of them together, at look {document.look.number} of {document.look.of}. <a href="/docs/regression">The manual</a> has the equations.</p><dl>{Object.entries(document.settings).map(([key, value]) => <><dt key={key}>{key.replace(/_/g, ' ')}</dt><dd><code>{JSON.stringify(value)}</code></dd></>)}</dl><RunAgain job={id} /></>} />
      <div class="stack"><Tests unit={unit} />
        <Panel title="What else changed">{document.findings.filter(finding => finding.sentence).length + document.comparability.filter(each => each.sentence).length === 0 ? <p class="sec">Nothing that was looked at.</p> : <ul class="rows plain">{document.findings.filter(finding => finding.sentence).map(finding => <li key={finding.check}>{finding.verdict !== 'ok' && <span class={`g ${finding.verdict === 'fail' ? 'bad' : 'warn'}`} aria-hidden="true">{finding.verdict === 'fail' ? '✗ ' : '△ '}</span>}{writeSentence(finding.sentence!)}</li>)}{document.comparability.filter(each => each.sentence).map(each => <li key={each.item}>{writeSentence(each.sentence!)}</li>)}</ul>}
          {document.versus_previous && <p class="note">Against {document.versus_previous.label}: {document.versus_previous.sentence}</p>}</Panel>
        <Panel title="Recordings" sub={`${plural(document.arms.baseline.sessions.length, 'session')} before, ${document.arms.candidate.sessions.length} after`}><ul class="rows plain">{[...new Set(recordings)].map(id => <li key={id}><RecordingLink id={id} /></li>)}</ul>{document.arms.excluded.map(each => <p key={each.recording} class="note">Left out: <RecordingLink id={each.recording} />, {each.reason}</p>)}</Panel></div>
    </div>}
    <Strip document={document} />
  </>;
}

// The verdict as a merge request shows it.
const markdown = (id: string): void => { ask(`/v1/regressions/${id}`, {headers: {Accept: 'text/markdown'}}).then(answer => answer.text()).then(text => copy(text, 'The Markdown is'), error => say((error as Error).message)); };

// A recording of each arm at a time, for their deviations over each other: as many as a comparison takes.
const COMPARED = 8;
function compared({arms}: Document): string[] {
  const of = (arm: Document['arms']['baseline']): string[] => arm.sessions.flatMap(session => session.recordings);
  const [before, after] = [of(arms.baseline), of(arms.candidate)];
  return [...new Set(Array.from({length: Math.max(before.length, after.length)}, (_, i) => [before[i], after[i]]).flat().filter((each): each is string => Boolean(each)))].slice(0, COMPARED);
}

export default function Regression(): JSX.Element {
  const {parts} = usePlace();
  const id = parts[1] ?? '';
  useTitle('Regression');
  const job = useRead<Job>(`/v1/jobs/${encodeURIComponent(id)}`);
  const read = useRead<Document>(job.data?.state === 'succeeded' ? `/v1/regressions/${encodeURIComponent(id)}` : null);
  useJobEvents(job.data && !job.data.finished_at ? id : null, job.again);
  const document = read.data;
  const sessions = document ? compared(document) : [];
  return <>
    <Head crumb={[['Regressions', '/regressions'], [document?.device ?? '…', null]]} title={document ? `${document.arms.candidate.label || 'Candidate'} against ${document.arms.baseline.label || 'the baseline'}` : 'Regression'}
      facts={[document?.device, document && `look ${document.look.number} of ${document.look.of}`]} actions={<>{document && sessions.length > 1 && <a class="btn" href={`/compare?with=${sessions.join(',')}`}>Compare</a>}{document && <><a class="btn" href={`/v1/regressions/${id}/junit`} download={`${id}.xml`}>JUnit</a><button type="button" class="btn" onClick={() => markdown(id)}>Markdown</button></>}
        {document?.arms.candidate.label && <Accept device={document.device} label={document.arms.candidate.label} />}<Report /></>} />
    {job.problem && <Refusal problem={job.problem} again={job.again} />}
    {job.data && !job.data.finished_at && <div role="status"><p class="verdict">{job.data.state === 'queued' ? 'Waiting for a worker' : `Comparing: ${job.data.stage ?? ''} ${Math.round(job.data.progress * 100)} %`}</p><Progress share={job.data.progress} label="Comparing" /></div>}
    {job.data?.finished_at && job.data.state !== 'succeeded' && <p class="verdict"><span class="g bad" aria-hidden="true">✗ </span>{job.data.problem?.detail ?? `The run is ${job.data.state}.`}</p>}
    {read.problem && <Refusal problem={read.problem} again={read.again} />}
    {document && <MadeBy job={id} document={`/v1/regressions/${id}`} />}
    {document ? <Shown document={document} id={id} /> : (job.data?.state ?? 'succeeded') === 'succeeded' && !job.problem && !read.problem && <Hairlines />}
  </>;
}
