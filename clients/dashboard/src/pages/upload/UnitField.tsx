// The unit of a column, and beside it what a count is in that unit: `deg/s` with `/131`, `degC` with `/340+36.53`.
import type {JSX} from 'preact';
import {useState} from 'preact/hooks';

// A unit of the list and what stands behind it. Of another unit, as a file may state it, nothing stands behind.
function parts(unit: string, known: string[]): [string, string] {
  const base = known.filter(one => unit.startsWith(one) && /^$|^[ */+-][ */+.\d-]*\d/.test(unit.slice(one.length))).sort((a, b) => b.length - a.length)[0];
  return base === undefined ? [unit, ''] : [base, unit.slice(base.length)];
}

export function UnitField({name, unit, known, set}: {name: string; unit: string; known: string[]; set: (unit: string) => void}): JSX.Element {
  const [base, scale] = parts(unit, known);
  const [typed, setTyped] = useState<string | null>(null);  // until it is said: the row may be drawn again meanwhile
  const units = known.includes(base) ? known : [base, ...known];
  return <span class="row">
    <select aria-label={`Unit of ${name}`} value={base} onChange={event => set(event.currentTarget.value + scale)}>{units.map(one => <option key={one}>{one}</option>)}</select>
    <input type="text" size={9} aria-label={`Scale and offset of ${name}`} title="Of counts: /131 says that 131 are one, /340+36.53 adds an offset" placeholder="/1+0" value={typed ?? scale} onInput={event => setTyped(event.currentTarget.value)} onChange={event => { setTyped(null); set(base + event.currentTarget.value.trim()); }} />
  </span>;
}
