// What was asked of a drive, answered: the sentence, the error in outages, what the filter knows of it, and the causes.
import type {JSX} from 'preact';
import {useMemo} from 'preact/hooks';
import {useJobEvents, useRead} from '../api/client';
import {writeNumber, writeQuantity, writeShare, writeTick} from '../format/number';
import {writeDuration, writeWhen} from '../format/time';
import {capital, plural, writeSentence, writeUnit} from '../format/words';
import {csvOf, save} from '../figure/export';
import {defaultReadout, Figure, Tools} from '../figure/Figure';
import {choose, listOf, pageOf, usePlace} from '../route';
import {RunAgain} from '../shell/Again';
import {Head} from '../shell/Head';
import {usePageKeys} from '../shell/keys';
import {MadeBy, Report} from '../shell/Report';
import {curlOf} from '../shell/copy';
import {NextRows} from '../shell/Pager';
import {Panel, Progress, Segments, Shown} from '../shell/states';
import {useTitle} from '../shell/title';
import {errorOf, isComparison, isExplanation, opened, SHORT, type Comparison, type Duration, type Estimated, type Evaluation, type Explanation, type Measured, type OutageOf, type Side, type Simulated} from './drive/documents';
import {FactsPanel} from './drive/Facts';
import {growthPlots, outagesPlot} from './drive/plots';
import {Where} from './drive/Where';

const ROWS = 20;

function Value({of, unit = ''}: {of: Estimated; unit?: string}): JSX.Element {
  const written = writeQuantity({...of, unit});
  return <><b>{written.value}</b> <span class="ci">{written.interval}</span></>;
}

const How = ({id}: {id: string}): JSX.Element => <><p>Fixes are withheld in stretches of each length, and what the filter then says of the end is set against the reference. Intervals are from a bootstrap over blocks of one period. A simulation draws readings and fixes from the same model along the recorded way and runs the same outages.</p><p><a href="/docs/drives">The manual</a> has the details.</p><RunAgain job={id} /></>;

function Errors({of, side, was, id, curl}: {of: Duration; side: Partial<Side>; was: Side | undefined; id: string; curl: string}): JSX.Element {
  const alike = <T extends {duration_s: number}>(list: T[] | undefined): T | undefined => list?.find(each => each.duration_s === of.duration_s);
  const simulated = alike(side.simulated);
  const plots = useMemo(() => growthPlots(of, simulated, alike(was?.durations), alike(was?.simulated)), [of, side, was]);
  return <Figure name={`${id}-error-${of.duration_s}s`} title={`Error in outages of ${of.duration_s} s`} sub={was ? 'before and after mending' : simulated ? 'measured, over the same simulated' : 'measured'} plots={plots} how={() => <How id={id} />} curl={curl} source={`driftlab, ${id}`}
    describe={`Horizontal error against the time without fixes, log-log: ${writeNumber(of.rms_m.value)} m after ${of.duration_s} s.${simulated ? ` Simulated, ${writeNumber(simulated.rms_m)} m.` : ''}`}
    readout={x => <><b>{writeNumber(x)} s</b>{defaultReadout(plots[0]!, x)}<span>m</span></>} quietReadout={<span>{capital(plural(of.n, 'outage'))} of {of.duration_s} s: {writeNumber(of.rms_m.value)} m, by its own covariance {writeNumber(of.promised_rms_m)} m.</span>} />;
}

function ByDuration({durations, simulated}: {durations: Duration[]; simulated: Simulated[] | undefined}): JSX.Element {
  const of = (each: Duration): Simulated | undefined => simulated?.find(one => one.duration_s === each.duration_s);
  const table = (): void => save('outages-by-duration.csv', 'text/csv', csvOf({heading: ['duration_s', 'n', 'rms_m', 'low_m', 'high_m', 'median_m', 'worst_m', 'along_rms_m', 'across_rms_m', 'nees', 'coverage95', 'promised_rms_m', 'simulated_rms_m', 'ratio'],
    rows: durations.map(each => [each.duration_s, each.n, each.rms_m.value, each.rms_m.ci95[0] ?? null, each.rms_m.ci95[1] ?? null, each.median_m.value, each.worst_m, each.along_rms_m, each.across_rms_m, each.nees.value, each.coverage95.value, each.promised_rms_m, of(each)?.rms_m ?? null, of(each)?.measured_over_simulated.value ?? null])}));
  return <Panel title="Outages by duration" sub="NEES: 2 where the filter knows itself" tools={<Tools title="The table" onCsv={table} />}>
    <div class="scroll"><table class="stacked"><thead><tr><th scope="col">without fixes</th><th scope="col" class="n">outages</th><th scope="col">rms, m</th><th scope="col" class="n">median</th><th scope="col" class="n">worst</th><th scope="col" class="n">along</th><th scope="col" class="n">across</th><th scope="col">NEES</th><th scope="col">in its 95 % ellipse</th>{simulated && <><th scope="col" class="n">simulated, m</th><th scope="col">measured ÷ simulated</th></>}</tr></thead>
      <tbody>{durations.map(each => { const beside = of(each); return <tr key={each.duration_s}><th scope="row">{each.duration_s} s</th><td class="n" data-label="outages">{each.n}</td><td data-label="rms, m"><Value of={each.rms_m} /></td><td class="n" data-label="median">{writeNumber(each.median_m.value)}</td><td class="n" data-label="worst">{writeNumber(each.worst_m)}</td><td class="n" data-label="along">{writeNumber(each.along_rms_m)}</td><td class="n" data-label="across">{writeNumber(each.across_rms_m)}</td><td data-label="NEES"><Value of={each.nees} /></td><td data-label="in its 95 % ellipse">{each.coverage95.value === null ? '…' : writeShare(each.coverage95.value)}</td>{simulated && <><td class="n" data-label="simulated, m">{beside ? writeNumber(beside.rms_m) : '–'}</td><td data-label="measured ÷ simulated">{beside ? <Value of={beside.measured_over_simulated} /> : '–'}</td></>}</tr>; })}</tbody></table></div>
  </Panel>;
}

function Outages({of, path, id, curl}: {of: Duration; path: Measured['path']; id: string; curl: string}): JSX.Element {
  const {query} = usePlace();
  const from = Math.max(0, Number(query.get('from')) || 0);
  const worstFirst = query.get('order') === 'worst';
  const plots = useMemo(() => [outagesPlot(of)], [of]);
  const rows = useMemo(() => [...of.outages].sort((a: OutageOf, b: OutageOf) => worstFirst ? errorOf(b) - errorOf(a) : a.start_s - b.start_s), [of, worstFirst]);
  return <>
    <div class="grid wide-side">
      <Figure name={`${id}-outages-${of.duration_s}s`} title={`Every outage of ${of.duration_s} s`} sub={`${of.n}, over all phases`} plots={plots} curl={curl} source={`driftlab, ${id}`} describe={`${of.n} outages of ${of.duration_s} s by their start; median ${writeNumber(of.median_m.value)} m, worst ${writeNumber(of.worst_m)} m.`} readout={x => <><b>{writeDuration(x)}</b>{defaultReadout(plots[0]!, x)}<span>m</span></>} />
      <Panel title="Where they ended" sub="with the error and the filter’s 95 % ellipse"><Where of={of} path={path} /></Panel>
    </div>
    <Panel title={`Table of outages of ${of.duration_s} s`} controls={<Segments label="Order" options={[['start', 'By start'], ['worst', 'Worst first']] as const} value={worstFirst ? 'worst' : 'start'} onChange={value => choose({order: value === 'worst' ? 'worst' : null, from: null})} />}>
      <div class="scroll" tabIndex={0} role="region" aria-label="Outages one by one"><table><thead><tr><th scope="col" class="n">start, s</th><th scope="col">motion</th><th scope="col" class="n">error, m</th><th scope="col" class="n">along</th><th scope="col" class="n">across</th><th scope="col" class="n">NEES</th><th scope="col" class="n">straight line, m</th><th scope="col" class="n">phase</th></tr></thead>
        <tbody>{rows.slice(from, from + ROWS).map((each, i) => <tr key={i}><th scope="row" class="n">{writeTick(each.start_s)}</th><td class="sec">{each.motion}</td><td class="n"><b>{writeNumber(errorOf(each))}</b></td><td class="n">{writeNumber(each.along_m)}</td><td class="n">{writeNumber(each.across_m)}</td><td class="n">{writeNumber(each.nees)}</td><td class="n">{writeNumber(each.straight_line_error_m)}</td><td class="n">{each.phase}</td></tr>)}</tbody></table></div>
      <NextRows from={from} rows={ROWS} count={rows.length} />
    </Panel>
  </>;
}

function Causes({evaluation}: {evaluation: Explanation}): JSX.Element {
  return <Panel title="Causes found" sub={evaluation.findings.length > 0 ? 'estimate and its standard error, the strongest first' : ''}>
    {evaluation.findings.length === 0 ? <p class="sec">None of those that are looked for reaches a score of 5 and three standard errors.</p> : <ul class="rows plain">{evaluation.findings.map(each => <li key={`${each.cause}${each.parameter}`} class="finding">
      <div><b>{capital(each.title)} {each.value === null ? '…' : writeNumber(each.value)}{each.se !== null ? ` ± ${writeNumber(each.se, 2)}` : ''} {writeUnit(each.unit)}</b> <span class="sec">score {writeNumber(each.score, 2)}, by {each.evidence}</span></div>
      <div class="u">{each.kept ? <><span class="g good" aria-hidden="true">✓ </span>mended{each.held_out_gain !== null ? `: log score ${each.held_out_gain >= 0 ? '+' : '−'}${writeNumber(Math.abs(each.held_out_gain))} on outages that were not used` : ''}</> : <><span class="g" aria-hidden="true">– </span>not kept: no gain on outages that were not used</>}{each.pair_words ? `; hardly told from ${each.pair_words}` : ''}</div>
      <div class="sec">{capital(each.told_apart)}.{each.at_bound && ' The search ends here: something else looks like it.'}</div></li>)}</ul>}
    <p class="note">White noise of the road: {writeNumber(evaluation.white_noise_factors.gyroscope)} times that of the model for the gyroscope, {writeNumber(evaluation.white_noise_factors.accelerometer)} for the accelerometer.</p>
  </Panel>;
}

function Steps({evaluation, duration}: {evaluation: Explanation; duration: number}): JSX.Element {
  return <Panel title="What mending gains" sub={`outages of ${duration} s that were not used to find it`}>
    <div class="scroll"><table class="stacked"><thead><tr><th scope="col">step</th><th scope="col" class="n">rms, m</th><th scope="col" class="n">NEES</th><th scope="col" class="n">in its 95 % ellipse</th><th scope="col" class="n">log score</th></tr></thead>
      <tbody>{evaluation.rungs.map(rung => { const held = rung.durations.find(each => each.duration_s === duration)?.held_out; return <tr key={rung.name} class={rung.kept ? '' : 'dim'}><th scope="row">{rung.name}{!rung.kept && <span class="u"> not kept</span>}</th><td class="n" data-label="rms, m">{held ? writeNumber(held.rms_m) : '–'}</td><td class="n" data-label="NEES">{writeNumber(held?.nees)}</td><td class="n" data-label="in its 95 % ellipse">{held ? writeShare(held.coverage95) : '–'}</td><td class="n" data-label="log score">{writeNumber(held?.log_score)}</td></tr>; })}</tbody></table></div>
    <p class="note">Each step has all those before it. NEES is 2 where the filter knows itself; a larger log score is better.</p>
  </Panel>;
}

// Several models: what is shown, in words, and each filter's errors.
function Compared({evaluation}: {evaluation: Comparison}): JSX.Element {
  const [first, ...others] = evaluation.verdicts.map(writeSentence);
  return <>
    <p class="verdict">{first}<small>{[...others, ...evaluation.notes].join(' ')}</small></p>
    {evaluation.filters.map(filter => <div key={filter.name} class="above"><h2>{filter.name}</h2><p class="sec">{filter.about}</p><ByDuration durations={filter.durations} simulated={undefined} /></div>)}
    <FactsPanel facts={evaluation.facts} />
  </>;
}

function Answer({evaluation, id}: {evaluation: Measured | Explanation; id: string}): JSX.Element {
  const {query} = usePlace();
  const explained = isExplanation(evaluation);
  const side = explained ? query.get('side') === 'before' ? evaluation.before : evaluation.after : evaluation;
  const {durations} = side;
  const [first, more] = opened(writeSentence(evaluation.summary));
  const chosen = durations.find(each => String(each.duration_s) === query.get('duration')) ?? durations[0];
  const drawn = explained ? evaluation.after.durations.find(each => each.duration_s === chosen?.duration_s) : chosen;
  const at = chosen ? durations.indexOf(chosen) : 0;
  const step = (by: number): void => { const next = durations[(at + by + durations.length) % Math.max(1, durations.length)]; if (next) choose({duration: String(next.duration_s), from: null}); };
  usePageKeys({'[': () => step(-1), ']': () => step(1)});
  const heading = explained ? [] : [evaluation.heading_known_s === null ? 'The heading is never known to 1°.' : `The heading is known to 1° from ${writeDuration(evaluation.heading_known_s)} on.`];
  const notes = [...evaluation.notes, ...heading, ...(explained || evaluation.natural_outages.length === 0 ? [] : [`The receiver itself was silent ${plural(evaluation.natural_outages.length, 'time')}; that is not scored.`]), ...(explained || evaluation.rejected_fixes === 0 ? [] : [`${plural(evaluation.rejected_fixes, 'fix', 'fixes')} rejected.`])];
  const curl = curlOf(`/v1/drive-evaluations/${id}`);
  return <>
    <p class="verdict">{first}{(more || notes.length > 0) && <small>{[more, ...notes].filter(Boolean).join(' ')}</small>}</p>
    {chosen && <>
      {durations.length > 1 && <div class="row no-print"><span class="sec">without fixes</span><Segments label="Duration" options={durations.map(each => [String(each.duration_s), `${each.duration_s} s`] as const)} value={String(chosen.duration_s)} onChange={value => choose({duration: value === String(durations[0]!.duration_s) ? null : value, from: null})} /></div>}
      <div class="grid wide-side">{drawn && <Errors of={drawn} side={explained ? evaluation.after : side} was={explained ? evaluation.before : undefined} id={id} curl={curl} />}{explained ? <Causes evaluation={evaluation} /> : <FactsPanel facts={evaluation.facts} />}</div>
      {explained && <div class="row no-print above"><Segments label="Model" options={[['after', 'Mended'], ['before', 'As it was']] as const} value={query.get('side') === 'before' ? 'before' : 'after'} onChange={value => choose({side: value === 'before' ? 'before' : null, from: null})} /><span class="sec">for the tables and figures below</span></div>}
      <ByDuration durations={durations} simulated={side.simulated} />
      {explained && <div class="grid two"><Steps evaluation={evaluation} duration={chosen.duration_s} /><FactsPanel facts={evaluation.facts} /></div>}
      {chosen.outages.length > 0 && <Outages of={chosen} path={evaluation.path} id={id} curl={curl} />}
    </>}
  </>;
}

export default function DriveEvaluation(): JSX.Element {
  const {parts} = usePlace();
  const read = useRead<Evaluation>(`/v1/drive-evaluations/${encodeURIComponent(parts[1] ?? '')}`);
  useJobEvents(read.data && !read.data.finished_at ? read.data.id : null, read.again);
  useTitle(read.data ? `Drive: ${read.data.name}` : 'Drive');
  return <Shown read={read} page="Evaluation of a drive">{stored => <>
    <Head crumb={[['Recorded drives', listOf('drives')], [stored.name, pageOf('drives', stored.drive)], [SHORT[stored.question], null]]} title={`${stored.name}, ${SHORT[stored.question]}`}
      facts={[stored.evaluation?.vehicle, `seed ${stored.seed}`, stored.evaluation && `algorithm ${stored.evaluation.algorithm_version}`, stored.finished_at ? `${writeWhen(stored.finished_at)}, took ${writeDuration((Date.parse(stored.finished_at) - Date.parse(stored.created_at)) / 1000)}` : 'running']}
      actions={<><a class="btn" href={pageOf('jobs', stored.id)}>Job</a><Report /></>} />
    <MadeBy job={stored.id} document={`/v1/drive-evaluations/${stored.id}`} />
    {stored.evaluation ? (isComparison(stored.evaluation) ? <Compared evaluation={stored.evaluation} /> : <Answer evaluation={stored.evaluation} id={stored.id} />) : <><p class="verdict" role="status">{stored.problem ? <><span class="g bad" aria-hidden="true">✗ </span>{stored.problem.detail}</> : stored.finished_at ? `The job was ${stored.state}; there is no result.` : `${stored.stage ?? 'Waiting for a worker'}, ${Math.round(stored.progress * 100)} %`}</p>{!stored.finished_at && <Progress share={stored.progress} label="Drive" />}</>}
  </>}</Shown>;
}
