// Keys that work on every page; a page adds its own by `usePageKeys`.
import {useLayoutEffect} from 'preact/hooks';
import {go, listOf} from '../route';

const PLACES: Record<string, string> = {l: '/', d: '/devices', i: '/investigations', o: '/outages', r: '/regressions', j: '/jobs', p: listOf('populations'), s: listOf('data-sheets'), v: listOf('drives'), w: listOf('webhooks')};
const GO_MS = 1200;

const typing = (target: EventTarget | null): boolean => target instanceof HTMLElement && (target.isContentEditable || ['INPUT', 'SELECT', 'TEXTAREA'].includes(target.tagName));

export function startKeys(help: () => void): void {
  let pressedG = 0;
  document.addEventListener('keydown', event => {
    if (event.defaultPrevented || event.ctrlKey || event.metaKey || event.altKey || typing(event.target)) return;
    if (event.key === '/') {
      event.preventDefault();
      const field = document.getElementById('find');
      if (field && !field.offsetParent) {  // on a narrow screen it is folded into the menu
        document.querySelector<HTMLButtonElement>('.bar .menu')?.click();
        setTimeout(() => field.focus());
      } else {
        field?.focus();
      }
    } else if (event.key === 'g') {
      pressedG = Date.now();
    } else if (Date.now() - pressedG < GO_MS && PLACES[event.key]) {
      pressedG = 0;
      go(PLACES[event.key]!);
    } else if (event.key === 'u') {
      go('/upload');
    } else if (event.key === '?') {
      help();
    }
  });
}

// In the layout phase, so that a key pressed once the page is seen never finds the listener of the page before.
export function usePageKeys(keys: Record<string, () => void>): void {
  useLayoutEffect(() => {
    const listener = (event: KeyboardEvent): void => {
      if (event.defaultPrevented || event.ctrlKey || event.metaKey || event.altKey || typing(event.target)) return;
      keys[event.key]?.();
    };
    document.addEventListener('keydown', listener);
    return () => document.removeEventListener('keydown', listener);
  });
}
