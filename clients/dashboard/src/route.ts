// The address is the view: every choice a reader makes stands in it.
import {useEffect, useState} from 'preact/hooks';

export interface Place {
  path: string;
  parts: string[];  // decoded segments, from the kind of the page on
  query: URLSearchParams;
}

export const listOf = (kind: string): string => `/${kind}`;

function read(): Place {
  const {pathname, search} = window.location;
  const parts = pathname.split('/').filter(Boolean).map(part => {
    try { return decodeURIComponent(part); } catch { return part; }
  });
  return {path: pathname, parts, query: new URLSearchParams(search)};
}

let place = read();
const listeners = new Set<() => void>();
const tell = (): void => {
  place = read();
  for (const listener of [...listeners]) listener();
};
window.addEventListener('popstate', tell);

export const here = (): Place => place;

export function go(href: string, options: {replace?: boolean} = {}): void {
  const before = place.path;
  window.history[options.replace ? 'replaceState' : 'pushState'](null, '', href);
  tell();
  if (place.path !== before) window.scrollTo(0, 0);
}

export interface QueryChange { [name: string]: string | null | undefined }

export function withQuery(changes: QueryChange, from: Place = place): string {
  const query = new URLSearchParams(from.query);
  for (const [name, value] of Object.entries(changes)) {
    if (value === null || value === undefined || value === '') query.delete(name);
    else query.set(name, value);
  }
  const text = query.toString().replace(/%3A/g, ':').replace(/%2C/g, ',');
  return from.path + (text ? `?${text}` : '');
}

// A deliberate choice is a step that Back undoes; a cursor is not.
export const choose = (changes: QueryChange): void => go(withQuery(changes));
export const hover = (changes: QueryChange): void => go(withQuery(changes), {replace: true});

export function usePlace(): Place {
  const [, again] = useState(place);
  useEffect(() => {
    const listener = (): void => again(place);
    listeners.add(listener);
    listener();  // Back may have come between drawing and this
    return () => { listeners.delete(listener); };
  }, []);
  return place;
}

const PAGES = /^\/(devices|recordings|compare|investigations|outages|jobs|upload|record|regressions|studies|models|calibrations|populations|data-sheets|webhooks|drives|drive-evaluations|docs|problems)?(\/|$)/;

// Links of the page itself do not load it again.
export function followLinks(): void {
  document.addEventListener('click', event => {
    if (event.defaultPrevented || event.button !== 0 || event.metaKey || event.ctrlKey || event.shiftKey || event.altKey) return;
    const link = (event.target as Element | null)?.closest?.('a');
    if (!link || link.target || link.hasAttribute('download') || link.origin !== window.location.origin) return;
    if (!PAGES.test(link.pathname) || (link.hash && link.pathname === window.location.pathname)) return;
    event.preventDefault();
    go(link.pathname + link.search);
  });
}

export const pageOf = (kind: string, id: string): string => `${listOf(kind)}/${encodeURIComponent(id)}`;
