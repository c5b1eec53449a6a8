// One recording: what it says, the evidence, the method.
import type {JSX} from 'preact';
import {useMemo, useState} from 'preact/hooks';
import {get, Problem, remove, useJobEvents, useRead, type Read} from '../api/client';
import type {Characterisation, CharacterisedChannel, Device, Histogram, Implied, Job, List, Recording} from '../api/documents';
import {useEvents} from '../api/events';
import {writeCount, writeNumber, writeP, writeTick} from '../format/number';
import {writeDuration} from '../format/time';
import {unitsFor} from '../format/units';
import {capital, conditionName, plural, sensorOf, writeUnit} from '../format/words';
import {defaultReadout, Figure} from '../figure/Figure';
import {choose, go, hover, pageOf, usePlace} from '../route';
import {RunAgain} from '../shell/Again';
import {Characterise} from '../shell/Characterise';
import {Delete} from '../shell/Delete';
import {Head, Verdict} from '../shell/Head';
import {usePageKeys} from '../shell/keys';
import {LiveLine, useLiveJobs} from '../shell/Live';
import {Report} from '../shell/Report';
import {curlOf} from '../shell/copy';
import {say} from '../shell/say';
import {Hairlines, Panel, Refusal, Segments, Shown} from '../shell/states';
import {useTitle} from '../shell/title';
import {useWide} from '../shell/wide';
import {describe, variancePlots, type Curve} from './recording/plots';
import {FilePanel, FittedModel, Ieee, OtherNames, Ranking} from './recording/Side';
import {Leftover} from './recording/Leftover';
import {Shape, shapePath} from './recording/Shape';
import {Signal} from './recording/Signal';
import {Spectrum, SpectrumMethod} from './recording/Spectrum';

const SENSORS = ['angular_rate', 'specific_force'];

export function qualityWords(recording: Recording): string {
  const {quality} = recording;
  const faults: string[] = [];
  if (quality.gaps > 0) faults.push(plural(quality.gaps, 'gap'));
  const sum = (pick: (c: NonNullable<Recording['quality']['channels']>[number]) => number): number => (quality.channels ?? []).reduce((total, channel) => total + pick(channel), 0);
  const frozen = sum(c => c.frozen);
  const saturated = sum(c => c.saturated);
  const missing = sum(c => c.missing + c.implausible);
  if (missing > 0) faults.push(`${plural(missing, 'value')} missing`);
  if (frozen > 0) faults.push(`${plural(frozen, 'sample')} frozen`);
  if (saturated > 0) faults.push(`${writeCount(saturated)} at full scale`);
  return faults.length > 0 ? faults.join(', ') : 'no gaps, no frozen stretch';
}

// How long it should take, from the newest characterisation of this daemon; the work grows with the number of values.
function Expected({recording}: {recording: Recording}): JSX.Element | null {
  const former = useRead<List<Job>>('/v1/jobs?kind=characterise&state=succeeded&sort=-created_at&limit=1');
  const job = former.data?.items[0];
  const inputs = job?.request.inputs.recordings ?? [];
  const other = useRead<Recording>(inputs.length === 1 ? `/v1/recordings/${inputs[0]!.id}` : null);
  const values = (of: Recording): number => of.quality.samples * Math.max(1, of.quality.channels?.length ?? 1);
  if (!job?.started_at || !job.finished_at || !other.data || values(other.data) === 0) return null;
  const took = (Date.parse(job.finished_at) - Date.parse(job.started_at)) / 1000;
  const expected = Math.max(1, Math.round(took * values(recording) / values(other.data)));
  return <small>About {expected < 10 ? `${expected} s` : writeDuration(expected)}, going by the last one: {writeDuration(Math.max(took, 0.1))} for {plural(values(other.data), 'value')}.</small>;
}

// The recording of the same device before or after this one, in the order of upload; refused at the ends.
async function neighbourOf(recording: Recording, by: 1 | -1): Promise<string> {
  let before: string | undefined;
  for (let cursor: string | null = ''; cursor !== null;) {
    const page: List<Recording> = await get(`/v1/recordings?device=${recording.device}&sort=${by < 0 ? '' : '-'}created_at&limit=50${cursor ? `&cursor=${cursor}` : ''}`);
    for (const {id} of page.items) {
      if (id === recording.id && before) return before;
      if (id === recording.id) throw new Error('there is none');
      before = id;
    }
    cursor = page.next_cursor;
  }
  throw new Error('there is none');
}

function How({result, channel}: {result: Characterisation; channel: CharacterisedChannel}): JSX.Element {
  const {result: c} = channel;
  return <>
    <p>The overlapping Allan variance and the Haar wavelet variance are computed at octaves with intervals from their equivalent degrees of freedom. Each candidate model is fitted to the wavelet variances by the generalised method of wavelet moments; the criterion ranks, the J test says whether the best of them fits. <a href="/docs/analysis">The manual</a> has the equations.</p>
    <dl>
      <dt>channel</dt><dd><code>{c.channel}</code>, {writeCount(c.samples)} samples at {writeNumber(1 / c.dt_s, 6)} Hz</dd>
      <dt>candidates</dt><dd>{result.parameters.models?.join(', ')}</dd>
      <dt>seed</dt><dd>{result.parameters.seed ?? 1}</dd>
      <dt>algorithm</dt><dd>version {result.algorithm_version}</dd>
      <dt>recording</dt><dd>{result.recording}, revision {result.revision}</dd>
      <dt>job</dt><dd><a href={`/jobs/${result.job}`}>{result.job}</a></dd>
      {c.contamination && <><dt>gross errors</dt><dd>{c.contamination.verdict}, {writeP(c.contamination.p)}, {writeCount(c.contamination.flagged_samples)} samples flagged</dd></>}
    </dl>
    {c.warnings.map(warning => <p key={warning} class="note"><span class="g warn" aria-hidden="true">△ </span>{warning}</p>)}
    <RunAgain job={result.job} />
  </>;
}

function Evidence({recording, result, channel, shape}: {recording: Recording; result: Characterisation; channel: CharacterisedChannel; shape: Read<Histogram>}): JSX.Element {
  const {query} = usePlace();
  const c = channel.result;
  const curve: Curve = query.get('curve') === 'haar' ? 'haar' : 'allan';
  const units = unitsFor(c.unit);
  const unit = units.includes(query.get('unit') ?? '') ? query.get('unit')! : units[0]!;
  const wanted = c.fits.findIndex(fit => fit.model === query.get('model'));
  const chosen = wanted >= 0 ? wanted : 0;
  const other = useRead<{implied: Implied}>(chosen > 0 && channel.fit_ids[chosen] ? `/v1/fits/${channel.fit_ids[chosen]}/implied` : null);
  const implied = chosen === 0 ? channel.implied : other.data?.implied ?? null;
  const fit = c.fits[chosen];
  const hidden = (query.get('show') ?? 'robust,components').split(',');
  const shown = {robust: hidden.includes('robust'), components: hidden.includes('components'), guides: hidden.includes('guides')};
  const plots = useMemo(() => variancePlots(c, fit, implied, unit, curve, shown), [c, fit, implied, unit, curve, query.get('show')]);
  const toggle = (name: keyof typeof shown): void => {
    const next = (['robust', 'components', 'guides'] as const).filter(each => each === name ? !shown[each] : shown[each]).join(',');
    choose({show: next === 'robust,components' ? null : next || 'none'});
  };
  const [hovered, setHovered] = useState<number | null>(null);
  const tau = hovered ?? (Number(query.get('tau')) || null);
  const point = (x: number | null, pinned: boolean): void => {
    setHovered(pinned ? null : x);
    if (pinned) hover({tau: x === null ? null : String(Number(x.toPrecision(6)))});
  };
  const path = `/v1/recordings/${recording.id}/characterisation?channel=${encodeURIComponent(c.channel)}`;
  const isWide = useWide();
  const file = <div class="grid two no-top">
    <OtherNames channel={c} />
    <FilePanel recording={recording} result={result} />
  </div>;
  const lastEdf = c.allan.edf?.[c.allan.edf.length - 1];
  return <><div class="grid main-side evidence">
    <div class="stack">
      <Figure name={`${recording.metadata.id ?? recording.id}-${c.axis ?? c.channel}-${curve}`} title={curve === 'allan' ? 'Allan deviation' : 'Haar wavelet deviation'}
        controls={<Segments label="Curve" options={[['allan', 'Allan'], ['haar', 'Haar wavelet']] as const} value={curve} onChange={value => choose({curve: value === 'allan' ? null : value})} />}
        sub={<><label><span class="visually-hidden">Unit </span><select value={unit} onChange={event => choose({unit: event.currentTarget.value === units[0] ? null : event.currentTarget.value})}>{units.map(each => <option key={each} value={each}>{writeUnit(each)}</option>)}</select></label>{' '}
          {(['robust', 'components', 'guides'] as const).map(name => <label key={name} class="nowrap"> <input type="checkbox" checked={shown[name]} onChange={() => toggle(name)} /> {name}</label>)}</>}
        describe={describe(c, fit, unit, curve)} plots={plots} cursor={tau} onCursor={point}
        readout={x => <><b>τ {writeNumber(x, 4)} s</b>{defaultReadout(plots[0]!, x)}<span>{writeUnit(unit)}</span></>}
        source={`driftlab, ${recording.id} ${c.channel}, algorithm ${result.algorithm_version}, seed ${result.parameters.seed ?? 1}`} curl={curlOf(path)} how={() => <How result={result} channel={channel} />}
        note={<><span class="no-print">Equal decades on both axes, so that a slope of −½ looks like one.</span>{lastEdf ? ` The last point has ${writeNumber(lastEdf, 2)} equivalent degrees of freedom; its interval says so.` : ''}{chosen > 0 && other.problem ? ` ${other.problem.document.detail}` : ''}</>} />
      <Spectrum recording={recording} channel={c} fit={fit} implied={implied} unit={unit} components={shown.components} tau={tau} onTau={point} />
      <Leftover recording={recording} channel={c} fit={fit} fitId={channel.fit_ids[chosen]} />
      {!isWide && file}
    </div>
    <div class="stack side">
      {fit && <FittedModel fit={fit} />}
      {c.fits.length > 0 && <Ranking fits={c.fits} chosen={chosen} onChoose={i => choose({model: i === 0 ? null : c.fits[i]!.model})} />}
      <Ieee channel={c} />
      <Shape recording={recording} channel={c} read={shape} />
      {isWide && file}
    </div>
  </div>
  <div class="print-only method foot"><How result={result} channel={channel} /><SpectrumMethod /></div></>;
}

function Body({recording}: {recording: Recording}): JSX.Element {
  const {query} = usePlace();
  const device = useRead<Device>(`/v1/devices/${recording.device}`);
  const read = useRead<Characterisation>(`/v1/recordings/${recording.id}/characterisation`);
  const live = useLiveJobs(recording.device).find(each => each.request.inputs.recordings?.some(one => one.id === recording.id));
  const liveJob = useRead<Job>(live ? `/v1/jobs/${live.id}` : null);
  useJobEvents(live?.id ?? null, liveJob.again);
  const job = liveJob.data?.finished_at ? undefined : liveJob.data ?? live;
  // The first result is shown when it is there; one that follows is offered, never put under a reader's eyes.
  const [newer, setNewer] = useState(false);
  useEvents(event => {
    if (event.type === 'result.created' && event.data.kind === 'characterise') {
      if (!read.data) read.again();
      else get<Job>(`/v1/jobs/${event.data.job}`).then(made => { if (made.request.inputs.recordings?.some(one => one.id === recording.id)) setNewer(true); }, () => undefined);
    } else if (!read.data && (event.type === 'ready' || event.type === 'reset')) {
      read.again();
    }
  });
  const channels = read.data?.channels ?? [];
  const columns = (recording.quality.channels ?? []).map(channel => channel.column);
  const named = query.get('ch');
  const channel = channels.find(one => one.result.channel === named) ?? channels[0];
  const column = channel?.result.channel ?? (named && columns.includes(named) ? named : columns[0]);
  const shape = useRead<Histogram>(channel ? shapePath(recording, channel.result.channel) : null);
  const select = (name: string): void => choose({ch: name});
  const step = (by: 1 | -1): void => { neighbourOf(recording, by).then(found => go(`${pageOf('recordings', found)}${named ? `?ch=${encodeURIComponent(named)}` : ''}`), () => say(by < 0 ? 'This is the first recording of the device.' : 'This is the last recording of the device.')); };
  usePageKeys({...Object.fromEntries(channels.slice(0, 9).map((one, i) => [String(i + 1), () => select(one.result.channel)])), c: () => go(`/compare?with=${recording.id}`), Escape: () => hover({tau: null}), '[': () => step(-1), ']': () => step(1)});
  const title = recording.metadata.id ?? `Recording of ${device.data?.name ?? '…'}`;
  useTitle(title);
  const deviceName = device.data?.name ?? recording.device;
  const [refused, setRefused] = useState<Problem>();
  const forget = (): void => { remove(`/v1/recordings/${recording.id}`).then(() => { say(`${title} is deleted.`); go(pageOf('devices', deviceName), {replace: true}); }, error => setRefused(error as Problem)); };
  const axis = channel?.result.axis ?? null;
  const label = (one: CharacterisedChannel): string => one.result.axis ? `${SENSORS.indexOf(one.result.quantity) === 1 ? 'f' : 'ω'} ${one.result.axis}` : one.result.channel;
  return <>
    <Head crumb={[['Devices', '/devices'], [deviceName, pageOf('devices', deviceName)], [conditionName(recording.metadata.condition), null]]} title={title}
      facts={[channel ? `${sensorOf(channel.result.quantity)} ${axis ?? ''}` : '', conditionName(recording.metadata.condition, axis),
        `${writeCount(recording.quality.samples)} samples${read.data ? ` at ${writeTick(Number(read.data.rate_hz.toPrecision(5)))} Hz, ${writeDuration(read.data.duration_s)}` : ''}`, qualityWords(recording), <><code>{recording.id.slice(0, 12)}…{recording.id.slice(-4)}</code> revision {recording.revision}</>]}
      actions={<>
        {channels.length > 1 && <Segments label="Channel" options={channels.map(one => [one.result.channel, label(one)] as const)} value={channel?.result.channel ?? ''} onChange={select} />}
        <a class="btn" href={`/compare?with=${recording.id}`}>Compare <kbd>c</kbd></a>
        <a class="btn" href={`/investigations?device=${encodeURIComponent(deviceName)}`}>Investigate</a>
        <Report />
        <Delete title="Delete this recording?" onDelete={forget}>{title}, its file and its results.</Delete>
      </>} />
    {refused && <Refusal problem={refused} />}
    {newer && <p class="note" role="status">Newer result. <button type="button" class="link" onClick={() => { setNewer(false); read.again(); }}>Show it</button></p>}
    {read.data?.stale && <p class="note">The recording was changed after it was characterised. <Characterise recordings={[recording.id]} label="Characterise again" onQueued={() => undefined} /></p>}
    {job && <LiveLine jobs={[job]} />}
    {channel && !job && <Verdict summary={channel.summary} />}
    {!read.data && !job && (read.problem?.document.status === 404
      ? <p class="verdict">Not characterised yet. <Characterise recordings={[recording.id]} label="Characterise" onQueued={read.again} /><Expected recording={recording} /></p>
      : read.problem ? <Refusal problem={read.problem} again={read.again} /> : <Hairlines />)}
    {column && <Signal recording={recording} column={column} quantity={channel?.result.quantity ?? 'sensor'} shape={shape.data} channel={channel?.result} />}
    {read.data && channel && <Evidence recording={recording} result={read.data} channel={channel} shape={shape} />}
    {!read.data && <div class="grid two"><Panel title="Quality"><p>{capital(qualityWords(recording))}.</p></Panel><FilePanel recording={recording} /></div>}
  </>;
}

export default function RecordingPage(): JSX.Element {
  const {parts} = usePlace();
  const read = useRead<Recording>(`/v1/recordings/${encodeURIComponent(parts[1] ?? '')}`);
  useTitle('Recording');
  return <Shown read={read} page="Recording">{recording => <Body recording={recording} />}</Shown>;
}
