// Steps through what is too long for one page: on to the next rows, and back to the first ones. Where it stands is in the address.
import type {JSX} from 'preact';
import {choose, usePlace} from '../route';

interface Stepped { name: string; next: string | null | undefined; back: string; on: string }

function Steps({name, next, back, on}: Stepped): JSX.Element | null {
  const isOn = usePlace().query.has(name);
  if (!isOn && !next) return null;
  return <p class="row">{isOn && <button type="button" class="btn" onClick={() => choose({[name]: null})}>{back}</button>}{next && <button type="button" class="btn" onClick={() => choose({[name]: next})}>{on}</button>}</p>;
}

// A list of the daemon's, whose pages follow each other by cursors.
export const Pager = ({next, back = 'Newest', on = 'Older'}: Partial<Stepped> & Pick<Stepped, 'next'>): JSX.Element => <Steps name="after" next={next} back={back} on={on} />;

// A list that is there as a whole, of which the page shows some.
export const NextRows = ({from, rows, count}: {from: number; rows: number; count: number}): JSX.Element => <Steps name="from" next={count > from + rows ? String(from + rows) : null} back="First" on={`Next ${rows}`} />;
