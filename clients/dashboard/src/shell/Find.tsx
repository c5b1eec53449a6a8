// The find field: what the daemon finds, and pages by their beginning; `/` goes to it.
import type {JSX} from 'preact';
import {useEffect, useRef, useState} from 'preact/hooks';
import {get} from '../api/client';
import {jobKind} from '../format/words';
import {go, listOf, pageOf} from '../route';

interface Hit { title: string; subtitle: string; href: string }
const PLACES: Hit[] = [
  {title: 'Upload', subtitle: 'recordings, a folder', href: '/upload'}, {title: 'Jobs', subtitle: 'what runs and what ran', href: '/jobs'},
  {title: 'Investigations', subtitle: 'what simulations get wrong', href: '/investigations'}, {title: 'Outages', subtitle: 'what error models are worth', href: '/outages'},
  {title: 'Populations', subtitle: 'all devices of a model', href: listOf('populations')}, {title: 'Data sheets', subtitle: 'what manufacturers state', href: listOf('data-sheets')},
  {title: 'Drives', subtitle: 'recorded drives, measured outages', href: listOf('drives')}, {title: 'Webhooks', subtitle: 'who is told when jobs end', href: listOf('webhooks')},
  {title: 'Compare', subtitle: 'several recordings side by side', href: '/compare'}, {title: 'Manual', subtitle: 'the pages of the documentation', href: '/docs'},
];
// What /v1/search does not seek is opened by its whole id.
const IDS: readonly (readonly [string, string])[] = [['stu_', 'studies'], ['cal_', 'calibrations'], ['drv_', 'drives'], ['whk_', 'webhooks']];
const WAIT_MS = 120;

async function hitsFor(text: string): Promise<Hit[]> {
  const wanted = text.trim().toLowerCase();
  const id = IDS.find(([prefix]) => text.trim().startsWith(prefix));
  if (id) return [{title: text.trim(), subtitle: `open by id`, href: pageOf(id[1], text.trim())}];
  const found = await get<{items: {kind: string; title: string; subtitle: string; href: string}[]}>(`/v1/search?q=${encodeURIComponent(text.trim())}&limit=10`);
  const named = found.items.map(hit => ({title: hit.kind === 'job' ? jobKind(hit.title) : hit.title, subtitle: hit.subtitle, href: hit.kind === 'device' ? pageOf('devices', hit.title) : hit.href.replace(/^\/v1/, '')}));
  return [...PLACES.filter(place => place.title.toLowerCase().startsWith(wanted)), ...named].slice(0, 12);
}

export function Find(): JSX.Element {
  const [text, setText] = useState('');
  const [hits, setHits] = useState<Hit[]>([]);
  const [chosen, setChosen] = useState(0);
  const field = useRef<HTMLInputElement>(null);
  useEffect(() => {
    if (!text.trim()) { setHits([]); return undefined; }
    let current = true;
    const timer = setTimeout(() => { hitsFor(text).then(found => { if (current) { setHits(found); setChosen(0); } }, () => undefined); }, WAIT_MS);
    return () => { current = false; clearTimeout(timer); };
  }, [text]);
  const open = (hit: Hit | undefined): void => {
    if (!hit) return;
    setText('');
    field.current?.blur();
    go(hit.href);
  };
  const shown = hits.length > 0;
  return <div class="find" role="search">
    <input id="find" ref={field} type="search" role="combobox" aria-label="Find a device, recording, job" aria-expanded={shown} aria-controls="found" aria-autocomplete="list"
      {...(shown ? {'aria-activedescendant': `hit-${chosen}`} : {})} placeholder="Find a device, recording, job" autocomplete="off" value={text}
      onInput={event => setText(event.currentTarget.value)} onBlur={() => setTimeout(() => setHits([]), 150)}
      onKeyDown={event => {
        if (event.key === 'ArrowDown' || event.key === 'ArrowUp') { event.preventDefault(); setChosen((chosen + (event.key === 'ArrowDown' ? 1 : -1) + hits.length) % Math.max(1, hits.length)); }
        else if (event.key === 'Enter') open(hits[chosen]);
        else if (event.key === 'Escape') { setText(''); event.currentTarget.blur(); }
      }} />
    {!text && <kbd aria-hidden="true">/</kbd>}
    <ul class="found" id="found" role="listbox" aria-label="Found" hidden={!shown}>
      {hits.map((hit, i) => <li key={hit.href} id={`hit-${i}`} role="option" aria-selected={i === chosen} onMouseDown={() => open(hit)}>{hit.title}<small>{hit.subtitle}</small></li>)}
    </ul>
  </div>;
}
