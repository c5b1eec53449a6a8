// One line at the bottom left for what is visible nowhere else; six seconds.
import type {JSX} from 'preact';
import {useEffect, useState} from 'preact/hooks';

const SHOWN_MS = 6000;
let show: (text: string) => void = () => undefined;

export const say = (text: string): void => show(text);

export function Said(): JSX.Element {
  const [text, setText] = useState('');
  useEffect(() => {
    let timer = 0;
    show = next => {
      setText(next);
      window.clearTimeout(timer);
      timer = window.setTimeout(() => setText(''), SHOWN_MS);
    };
    return () => { show = () => undefined; };
  }, []);
  return <div role="status">{text && <div class="said">{text}</div>}</div>;
}
