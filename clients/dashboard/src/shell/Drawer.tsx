// The drawer at the right: how something was computed. Esc closes it and gives the focus back.
import type {JSX} from 'preact';
import {useEffect, useLayoutEffect, useRef, useState} from 'preact/hooks';

interface Open { title: string; content: () => JSX.Element }
let show: (open: Open | null) => void = () => undefined;

export const openDrawer = (title: string, content: () => JSX.Element): void => show({title, content});
export const closeDrawer = (): void => show(null);

export function Drawer(): JSX.Element | null {
  const [open, setOpen] = useState<Open | null>(null);
  const before = useRef<Element | null>(null);
  const heading = useRef<HTMLHeadingElement>(null);
  useEffect(() => {
    show = next => {
      if (next) before.current = document.activeElement;
      setOpen(next);
      if (!next && before.current instanceof HTMLElement) before.current.focus();
    };
    return () => { show = () => undefined; };
  }, []);
  // In the frame in which it appears: an Esc that follows at once must find the drawer in focus.
  useLayoutEffect(() => { if (open) heading.current?.focus(); }, [open]);
  if (!open) return null;
  return <div class="drawer" role="dialog" aria-label={open.title} onKeyDown={event => { if (event.key === 'Escape') { event.stopPropagation(); closeDrawer(); } }}>
    <div class="row"><h2 tabIndex={-1} ref={heading}>{open.title}</h2><button type="button" class="btn right" onClick={closeDrawer}>Close</button></div>
    {open.content()}
  </div>;
}
