// What the quality of a recording says, each sentence with the samples that it speaks of.
import type {JSX} from 'preact';
import type {Recording, Trace} from '../../api/documents';
import {writeTick} from '../../format/number';
import {writeDuration} from '../../format/time';
import {countWord, plural, writeSentence} from '../../format/words';
import {choose, usePlace} from '../../route';

export type PlaceKind = 'trim' | 'gap' | 'missing' | 'flagged' | 'frozen' | 'saturated';
export interface Place { kind: PlaceKind; t0: number; t1: number; missing?: number }

// A stretch that lacks samples is a gap where the time column says so, else cells without a number.
export function placesOf(trace: Trace): Place[] {
  const flags: Place[] = trace.flags;
  const missing = trace.missing.map(([t0, t1]): Place => ({kind: 'missing', t0, t1}));
  return [...flags, ...missing];
}

const MARKS: Record<PlaceKind, string> = {trim: '░', gap: '▒', missing: '▒', flagged: '▼', frozen: '▁', saturated: '▔'};
const LEAST_SAMPLES = 60;  // about a place, so that it is seen among its neighbours
const LISTED = 6;

const KINDS: Record<PlaceKind, (places: readonly Place[]) => string> = {
  trim: places => `${writeDuration(places.reduce((sum, place) => sum + place.t1 - place.t0, 0))} trimmed`,
  gap: places => `${plural(places.length, 'gap')}, ${plural(places.reduce((sum, place) => sum + (place.missing ?? 0), 0), 'sample')} missing in ${places.length === 1 ? 'it' : 'them'}`,
  missing: places => `${plural(places.length, 'stretch', 'stretches')} without a number`,
  flagged: places => `${plural(places.length, 'stretch', 'stretches')} with no measurement in ${places.length === 1 ? 'it' : 'them'}`,
  frozen: places => `frozen for ${writeDuration(places.reduce((sum, place) => sum + place.t1 - place.t0, 0))}`,
  saturated: places => `${plural(places.length, 'stretch', 'stretches')} at full scale`,
};

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
      // The longest ones where there are more than a line holds, in the order of time.
      const first = [...list].sort((a, b) => (b.missing ?? b.t1 - b.t0) - (a.missing ?? a.t1 - a.t0)).slice(0, LISTED).sort((a, b) => a.t0 - b.t0);
      return <span key={kind} class="quality-note"><span aria-hidden="true" class={`mark-${kind}`}>{MARKS[kind]} </span>{KINDS[kind](list)}{list.length > LISTED ? `; the ${countWord(LISTED)} longest at ` : ': at '}
        {first.map((place, i) => { const to = shown(place); return <span key={place.t0}>{i > 0 && ', '}<button type="button" class="link" aria-pressed={query.get('t0') === to.t0} onClick={() => choose(to)}>{writeTick(Number(place.t0.toPrecision(6)))} s</button></span>; })}. </span>;
    })}</>;
}
