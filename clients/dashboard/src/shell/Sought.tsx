// A field that narrows a list on the daemon. What is typed is one step that Back undoes, however many letters it has.
import type {JSX} from 'preact';
import {useEffect, useRef, useState} from 'preact/hooks';
import {choose, hover, usePlace} from '../route';

const PAUSE_MS = 200;

export function Sought({label}: {label: string}): JSX.Element {
  const said = usePlace().query.get('q') ?? '';
  const [text, setText] = useState(said);
  const told = useRef(said);       // what the address holds because of this field
  const typing = useRef(false);    // the step of this typing is in the history already
  const timer = useRef(0);
  useEffect(() => {
    if (said === told.current) return;
    told.current = said;
    typing.current = false;
    setText(said);
  }, [said]);
  useEffect(() => () => clearTimeout(timer.current), []);
  const tell = (value: string): void => {
    clearTimeout(timer.current);
    if (value.trim() === told.current) return;
    told.current = value.trim();
    (typing.current ? hover : choose)({q: told.current || null, after: null});
    typing.current = true;
  };
  return <input type="search" aria-label={label} placeholder={label} value={text} onInput={event => {
    const {value} = event.currentTarget;
    setText(value);
    clearTimeout(timer.current);
    timer.current = window.setTimeout(() => tell(value), PAUSE_MS);
  }} onBlur={() => { tell(text); typing.current = false; }} />;
}
