// What a page gives to the clipboard.
import {say} from './say';

export function curlOf(path: string): string {
  return `curl '${window.location.origin}${path}'`;
}

export function copy(text: string, what: string): void {
  navigator.clipboard.writeText(text).then(() => say(`${what} copied.`), () => say('The browser does not let this page copy.'));
}
