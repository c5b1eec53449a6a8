// What the quality of a recording says, each sentence with the samples that it speaks of.
import type {JSX} from 'preact';
import type {Channel, Histogram, Recording, Trace} from '../../api/documents';
import {writeNumber, writeTick} from '../../format/number';
import {writeDuration} from '../../format/time';
import {countWord, plural, writeSentence, writeUnit} from '../../format/words';
import {choose, usePlace} from '../../route';

export type PlaceKind = 'trim' | 'gap' | 'missing' | 'flagged' | 'frozen' | 'saturated' | 'apart' | 'jump' | 'level';
export interface Place { kind: PlaceKind; t0: number; t1: number; missing?: number; samples?: number; deviations?: number; size?: string }

// A stretch that lacks samples is a gap where the time column says so, else cells without a number.
export function placesOf(trace: Trace): Place[] {
  const flags: Place[] = trace.flags;
  const missing = trace.missing.map(([t0, t1]): Place => ({kind: 'missing', t0, t1}));
  return [...flags, ...missing];
}

// What the samples themselves show: values apart from the rest, and where the noise is not the same before and after, whose times count from
// the first analysed sample.
export function foundIn(recording: Recording, shape: Histogram | undefined, channel: Channel | undefined): Place[] {
  const first = recording.metadata.trim?.start_s ?? 0;
  const apart = (shape?.apart ?? []).map((place): Place => ({kind: 'apart', ...place}));
  const changes = (channel?.stationarity?.changes ?? []).map(({kind, time_s: time, size, unit}): Place => ({kind, t0: first + time, t1: first + time, size: kind === 'jump' ? `${writeNumber(size)} ${writeUnit(unit)}` : `${writeNumber(size)} times`}));
  return [...apart, ...changes];
}

const MARKS: Record<PlaceKind, string> = {trim: '░', gap: '▒', missing: '▒', flagged: '▼', frozen: '▁', saturated: '▔', apart: '◇', jump: '┆', level: '┆'};
const LEAST_SAMPLES = 60;  // about a place, so that it is seen among its neighbours
const LISTED = 6;
const MOST_APART = 200;  // places that the API tells

const KINDS: Record<PlaceKind, (places: readonly Place[]) => string> = {
  trim: places => `${writeDuration(places.reduce((sum, place) => sum + place.t1 - place.t0, 0))} trimmed`,
  gap: places => `${plural(places.length, 'gap')}, ${plural(places.reduce((sum, place) => sum + (place.missing ?? 0), 0), 'sample')} missing in ${places.length === 1 ? 'it' : 'them'}`,
  missing: places => `${plural(places.length, 'stretch', 'stretches')} without a number`,
  flagged: places => `${plural(places.length, 'stretch', 'stretches')} with no measurement in ${places.length === 1 ? 'it' : 'them'}`,
  frozen: places => `frozen for ${writeDuration(places.reduce((sum, place) => sum + place.t1 - place.t0, 0))}`,
  saturated: places => `${plural(places.length, 'stretch', 'stretches')} at full scale`,
  apart: places => `${places.length === MOST_APART ? 'at least ' : ''}${plural(places.reduce((sum, place) => sum + (place.samples ?? 0), 0), 'value')} apart from the rest, more than 8 σ from the median around them`,
  jump: places => `the mean jumps by ${places.map(place => place.size).join(', ')}`,
  level: places => `the noise changes, to ${places.map(place => place.size).join(', ')} what it was`,
};

// Which are named where there are more than a line holds: values by how far out they are, changes from the first on, stretches by length.
const NAMED: Partial<Record<PlaceKind, readonly [string, (place: Place) => number]>> = {apart: ['farthest out', place => place.deviations ?? 0], jump: ['first', place => -place.t0], level: ['first', place => -place.t0]};
const LONGEST = ['longest', (place: Place) => place.missing ?? place.t1 - place.t0] as const;

interface PlacesProps { recording: Recording; column: string; places: readonly Place[]; duration: number; rate: number }

export function Places({recording, column, places, duration, rate}: PlacesProps): JSX.Element | null {
  const {query} = usePlace();
  const kinds = (Object.keys(MARKS) as PlaceKind[]).filter(kind => places.some(place => place.kind === kind));
  const shown = ({t0, t1}: Place): {t0: string; t1: string} => {
    const more = Math.max(t1 - t0, LEAST_SAMPLES / rate);
    return {t0: Math.max(0, t0 - more).toPrecision(7), t1: Math.min(duration, t1 + more).toPrecision(7)};
  };
  const notes = recording.quality.notes.filter(note => !note.startsWith("Column '") || note.startsWith(`Column '${column}'`));
  if (kinds.length === 0 && notes.length === 0) return null;
  return <>{notes.map(note => <span key={note} class="quality-note">{writeSentence(note)} </span>)}
    {kinds.map(kind => {
      const list = places.filter(place => place.kind === kind);
      const [word, rank] = NAMED[kind] ?? LONGEST;
      const first = [...list].sort((a, b) => rank(b) - rank(a)).slice(0, LISTED).sort((a, b) => a.t0 - b.t0);
      return <span key={kind} class="quality-note"><span aria-hidden="true" class={`mark-${kind}`}>{MARKS[kind]} </span>{KINDS[kind](list)}{list.length > LISTED ? `; the ${countWord(LISTED)} ${word} at ` : ': at '}
        {first.map((place, i) => { const to = shown(place); return <span key={place.t0}>{i > 0 && ', '}<button type="button" class="link" aria-pressed={query.get('t0') === to.t0} onClick={() => choose(to)}>{writeTick(Number(place.t0.toPrecision(6)))} s</button></span>; })}. </span>;
    })}</>;
}
