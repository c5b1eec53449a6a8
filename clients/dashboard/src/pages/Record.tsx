// Record this phone: its sensors into a recording that grows, with the Allan deviation so far.
import type {JSX} from 'preact';
import {useEffect, useRef, useState} from 'preact/hooks';
import {Problem, send, useRead} from '../api/client';
import type {Job, Recording} from '../api/documents';
import {writeCount} from '../format/number';
import {conditionName, type Condition} from '../format/words';
import {go, pageOf, usePlace} from '../route';
import {Head} from '../shell/Head';
import {Panel, Refusal, Shown} from '../shell/states';
import {useTitle} from '../shell/title';
import {ConditionField} from './upload/ConditionField';
import {Code, wordOf} from './record/Code';
import {GrowthPanel, useGrowth} from './record/Growth';
import {Sender} from './record/sender';
import {COLUMNS, liesStill, NAMES, openSensors, whyNot, type Row} from './record/sensors';

interface LiveRecording { id: string; device: string; condition: Condition; columns: string[]; samples: number; token?: string; href?: string }
type Step = 'before' | 'checking' | 'recording' | 'ending';

const CHECK_S = 3;
const STRIP_S = 8;
const STRIP_MS = 150;

const clock = (seconds: number): string => `${Math.floor(seconds / 60)}:${String(Math.floor(seconds % 60)).padStart(2, '0')}`;

function conditionDocument(text: string): Condition {
  const [kind = 'static', axis, value, unit] = text.split(':');
  return axis ? {kind, axis, value: Number(value), unit: unit ?? ''} : {kind};
}

function Begin({onMade}: {onMade: (live: LiveRecording) => void}): JSX.Element {
  const [device, setDevice] = useState('');
  const [condition, setCondition] = useState('static');
  const [problem, setProblem] = useState<Problem>();
  const fault = whyNot();
  const make = (here: boolean): void => {
    setProblem(undefined);
    send<LiveRecording>('POST', '/v1/live-recordings', {device: device.trim(), condition: conditionDocument(condition), columns: COLUMNS})
      .then(live => { if (here) go(live.href ?? `/record?live=${live.id}#${live.token}`); else onMade(live); }, error => setProblem(error as Problem));
  };
  return <Panel title="What is recorded">
    <div class="row"><label>device <input type="text" size={18} aria-label="Device" placeholder="phone-07" value={device} onInput={event => setDevice(event.currentTarget.value)} /></label>
      <label>condition <ConditionField label="Condition" value={condition} onChange={setCondition} /></label></div>
    {problem && <Refusal problem={problem} />}
    <p class="row"><button type="button" class="btn primary" disabled={!device.trim() || fault !== null} onClick={() => make(true)}>Record with this device</button>
      <button type="button" class="btn" disabled={!device.trim()} onClick={() => make(false)}>Show a code for my phone</button></p>
    {fault && <p class="note">{fault}</p>}
    <p class="note">Gyroscope and accelerometer, 100 readings a second where the browser gives them; many give 60 and round them. Lay the phone on something solid.</p>
  </Panel>;
}

// The screen beside the phone: the code, then how the recording grows.
function Beside({live}: {live: LiveRecording}): JSX.Element {
  const [channel, setChannel] = useState('gz');
  const growing = useGrowth(live.id, channel, () => go(pageOf('devices', live.device)));
  const address = `${window.location.origin}${live.href ?? ''}`;
  return <>
    <Panel title={growing ? `${writeCount(growing.samples)} samples` : 'Open this on the phone'} sub={<>pairing word <b>{wordOf(live.id)}</b>, the phone shows the same</>}>
      {!growing && <><Code address={address} /><p class="note"><code>{address}</code></p>
        {/^(localhost|127\.)/.test(window.location.hostname) && <p class="note">A phone cannot reach {window.location.hostname}: start the daemon on an address of your network, with TLS.</p>}</>}
    </Panel>
    {growing && <GrowthPanel growing={growing} channel={channel} onChannel={setChannel} />}
  </>;
}

function Strip({rows, channel}: {rows: readonly Row[]; channel: string}): JSX.Element {
  const index = NAMES.indexOf(channel as (typeof NAMES)[number]);
  const end = rows[rows.length - 1]?.time ?? 0;
  const points = rows.filter(row => row.time > end - STRIP_S && Number.isFinite(row.values[index]));
  const values = points.map(row => row.values[index]!);
  const low = Math.min(...values);
  const high = Math.max(...values);
  const line = points.map(row => `${((row.time - end + STRIP_S) / STRIP_S * 340).toFixed(1)},${(high > low ? 66 - (row.values[index]! - low) / (high - low) * 62 : 35).toFixed(1)}`).join(' ');
  return <svg class="strip" viewBox="0 0 340 70" width="100%" height="70" preserveAspectRatio="none" aria-hidden="true"><polyline points={line} fill="none" stroke="var(--measured)" stroke-width="1" vector-effect="non-scaling-stroke" /></svg>;
}

function Recorder({live, token}: {live: LiveRecording; token: string}): JSX.Element {
  const [step, setStep] = useState<Step>('before');
  const [channel, setChannel] = useState('gz');
  const [, again] = useState(0);
  const [sentence, setSentence] = useState<string | null>(null);
  const [unsent, setUnsent] = useState<string | null>(null);
  const [problem, setProblem] = useState<Problem>();
  const rows = useRef<Row[]>([]);
  const began = useRef(0);
  const count = useRef(0);
  const stage = useRef<Step>('before');
  const sensors = useRef(openSensors());
  const sender = useRef<Sender | null>(null);
  const growing = useGrowth(live.id, channel, () => undefined);
  const enter = (next: Step): void => { stage.current = next; setStep(next); };

  const check = (): void => {
    setSentence(null);
    rows.current = [];
    enter('checking');
    sensors.current.start(row => {
      rows.current.push(row);
      if (rows.current.length > 2000) rows.current.splice(0, 1000);
      if (stage.current === 'recording') { sender.current?.add(row); count.current += 1; }
    }, fault => { setSentence(fault); enter('before'); sensors.current.stop(); });
  };
  const start = (): void => {
    began.current = Date.now();
    count.current = 0;
    sender.current = new Sender(live.id, token, (left, why) => setUnsent(left > 0 ? `${writeCount(left)} samples are not stored yet. ${why ?? ''}` : null));
    sender.current.start();
    enter('recording');
  };
  const finish = (): void => {
    enter('ending');
    sensors.current.stop();
    (sender.current?.flush() ?? Promise.resolve())
      .then(() => send<{recording: Recording; job: Job | null}>('POST', `/v1/live-recordings/${live.id}/finish`, undefined, {'Live-Token': token}))
      .then(made => go(pageOf('recordings', made.recording.id)), error => { if (error instanceof Problem) setProblem(error); else setSentence((error as Error).message); });
  };
  useEffect(() => {
    const timer = setInterval(() => again(n => n + 1), STRIP_MS);
    const hidden = (): void => {
      if (!document.hidden || stage.current !== 'recording') return;
      sensors.current.stop();
      enter('ending');
      setSentence(`The page was hidden: stopped at ${clock((Date.now() - began.current) / 1000)}. What was recorded is kept.`);
      void sender.current?.flush().catch(() => undefined);
    };
    document.addEventListener('visibilitychange', hidden);
    return () => { clearInterval(timer); document.removeEventListener('visibilitychange', hidden); sensors.current.stop(); };
  }, []);
  useEffect(() => {
    if (step !== 'recording') return undefined;
    let lock: {release: () => Promise<void>} | null = null;
    (navigator as Navigator & {wakeLock?: {request: (kind: 'screen') => Promise<{release: () => Promise<void>}>}}).wakeLock?.request('screen').then(held => { lock = held; }, () => undefined);
    return () => { void lock?.release(); };
  }, [step]);

  const seen = rows.current;
  const span = seen.length > 1 ? seen[seen.length - 1]!.time - seen[0]!.time : 0;
  const rate = span > 0.5 ? (seen.length - 1) / span : null;
  const checked = step === 'checking' && span >= CHECK_S;
  const still = liesStill(seen.filter(row => row.time > (seen[seen.length - 1]?.time ?? 0) - CHECK_S));
  const seconds = step === 'recording' ? (Date.now() - began.current) / 1000 : 0;
  const name = `${live.device}, ${conditionName(live.condition)}`;
  const fault = whyNot();
  return <>
    <Head crumb={[['Record this phone', '/record'], [wordOf(live.id), null]]} title={name} facts={[<>pairing word <b>{wordOf(live.id)}</b></>]} />
    {fault && <p class="verdict">{fault}</p>}
    {sentence && <p class="verdict" role="alert">{sentence}</p>}
    {problem && <Refusal problem={problem} again={finish} />}
    {step === 'before' && !fault && <p><button type="button" class="btn primary big" onClick={check}>Allow sensors</button></p>}
    {step === 'recording' && <div class="live-head"><strong>{clock(seconds)}</strong><span><span class="dot-live" aria-hidden="true">● </span>recording<br />{writeCount(count.current)} samples{rate ? `, ${rate.toFixed(1)} Hz` : ''}</span></div>}
    {(step === 'checking' || step === 'recording') && <section class="panel"><Strip rows={seen} channel={channel} />
      <p class="sec">{channel.startsWith('g') ? 'gyroscope' : 'accelerometer'} {channel.slice(1)}, last {STRIP_S} s · {still ? <><span class="g good" aria-hidden="true">✓ </span>lying still</> : <><span class="g warn" aria-hidden="true">△ </span>it moves</>}{rate && rate < 90 ? ` · this browser gives ${rate.toFixed(0)} Hz; the recording is still worth having` : ''}</p></section>}
    {step === 'checking' && <p><button type="button" class="btn primary big" disabled={!checked} onClick={start}>{checked ? 'Start' : 'Looking at the sensors for 3 s'}</button>{checked && !still && live.condition.kind === 'static' ? ' It moves: put it down, or start all the same.' : ''}</p>}
    {step === 'recording' && <GrowthPanel growing={growing} channel={channel} onChannel={setChannel} />}
    {unsent && <p class="note" role="status">{unsent}</p>}
    {(step === 'recording' || step === 'ending') && <><p><button type="button" class="btn primary big" disabled={step === 'ending' && !sentence && !problem} onClick={finish}><span aria-hidden="true">■ </span>Stop and characterise</button></p>
      <p class="sec">Keep this page open. What is recorded is stored every second.</p></>}
  </>;
}

function Continue({id, token}: {id: string; token: string}): JSX.Element {
  const read = useRead<LiveRecording>(`/v1/live-recordings/${encodeURIComponent(id)}`);
  if (read.problem?.document.status === 404) return <p class="verdict">This recording is finished, or was never begun. <a href="/record">Begin another</a> or <a href="/devices">see the devices</a>.</p>;
  return <Shown read={read} page="Record this phone">{live => <Recorder live={live} token={token} />}</Shown>;
}

export default function Record(): JSX.Element {
  const {query} = usePlace();
  const [live, setLive] = useState<LiveRecording>();
  useTitle('Record this phone');
  const id = query.get('live');
  if (id) return <Continue id={id} token={window.location.hash.slice(1)} />;
  return <>
    <Head title="Record this phone" facts={['a phone at rest is a recording; its noise model grows while you wait']} />
    {live ? <Beside live={live} /> : <Begin onMade={setLive} />}
  </>;
}
