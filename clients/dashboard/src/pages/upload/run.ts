// Sending what waits, the jobs that follow, and where their figures will be.
import {ask, Problem} from '../../api/client';
import {go, pageOf} from '../../route';
import {characterise} from '../../shell/Characterise';
import {addFiles, change, pending, remember, toSend, type Pending} from './pending';
import {Paused, upload} from './send';
import {investigated, matched, readStudy, type Study} from './study';

const running = new Map<number, AbortController>();

export const pause = (key: number): void => running.get(key)?.abort();

export async function sendOne(each: Pending): Promise<string | null> {
  change(each.key, {state: 'sending', problem: null});
  const stop = new AbortController();
  running.set(each.key, stop);
  try {
    const recording = await upload(each, share => change(each.key, {share}), stop.signal);
    remember(each);
    change(each.key, {state: 'sent', share: 1, recording: recording.id});
    return recording.id;
  } catch (error) {
    if (error instanceof Paused) change(each.key, {state: 'paused'});
    else change(each.key, {state: 'refused', problem: error as Problem});
    return null;
  } finally {
    running.delete(each.key);
  }
}

// Where what was sent shows its figures: its recording, its device, or the Lab with all of them.
function landingOf(sent: readonly Pending[]): string {
  if (sent.length === 1) return pageOf('recordings', sent[0]!.recording!);
  const devices = new Set(sent.map(each => each.device));
  return devices.size === 1 ? pageOf('devices', sent[0]!.device) : '/';
}

// --- a study that was dropped, with the keys of its files
let study: {document: Study; keys: number[]} | null = null;

// Files of a drop: a study.json says what the others are.
export async function take(files: readonly File[]): Promise<void> {
  const described = files.find(file => /(^|\/|[-_])study\.json$/i.test(file.name));
  if (!described) { addFiles(files); return; }
  const document = await readStudy(described);
  const found = matched(document, files);
  for (const [file, said] of found) addFiles([file], said);
  const keys = found.map(([file]) => pending().find(each => each.file === file)?.key ?? 0);
  study = {document, keys};
}
const whole = (): boolean => study !== null && study.keys.every(key => pending().some(each => each.key === key));
// What follows an upload, in a word.
export const following = (): 'investigate' | 'characterise' => whole() ? 'investigate' : 'characterise';

// Sends all that waits and, where it is asked for, characterises it and goes to its figures. What is refused keeps the page.
export async function sendAll(analyse: boolean): Promise<void> {
  const waiting = toSend(pending()).map(each => each.key);
  for (const each of pending().filter(one => waiting.includes(one.key))) await sendOne(each);
  const sent = pending().filter(each => waiting.includes(each.key) && each.state === 'sent');
  if (!analyse) return;
  const recordings = whole() ? study!.keys.map(key => pending().find(each => each.key === key)?.recording) : [];
  if (study && recordings.length > 0 && recordings.every(Boolean)) {
    const job = await investigated(study.document, recordings as string[]);
    study = null;
    go(pageOf('jobs', job.id));
    return;
  }
  for (const {key, recording} of sent) change(key, {job: (await characterise([recording!])).id});
  if (sent.length > 0 && pending().every(each => each.state === 'sent')) go(landingOf(sent));
}

// --- the sample: two recordings of a phone's gyroscope that the daemon simulates
const SAMPLE = 'iphone5s-simulated';
const CONDITIONS: readonly (readonly [string, string])[] = [['static', 'iphone5s-z-static.csv'], ['constant_rate:z:9:deg/s', 'iphone5s-z-9-deg-s.csv']];

let wanted = false;

let handed: readonly File[] = [];

// Hands files to the page Upload, which is opened next.
export const askFor = (files: readonly File[]): void => { handed = files; };
export const takeHanded = (): readonly File[] => { const files = handed; handed = []; return files; };

// Asks the page Upload, which is opened next, to run it.
export const askForSample = (): void => { wanted = true; };
export const takeSample = (): boolean => { const asked = wanted; wanted = false; return asked; };

export async function runSample(): Promise<void> {
  for (const [condition, name] of CONDITIONS) {
    const answer = await ask(`/v1/samples/iphone5s-z?condition=${encodeURIComponent(condition)}`);
    addFiles([new File([await answer.blob()], name, {lastModified: 0})], {device: SAMPLE, condition, rate: '100'});
  }
  await sendAll(true);
}
