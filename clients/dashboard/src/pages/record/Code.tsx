// A code that the camera of a phone reads, and the word by which both screens know each other.
import type {JSX} from 'preact';
import {encode} from 'uqr';

export const wordOf = (id: string): string => id.slice(-4);

export function Code({address}: {address: string}): JSX.Element {
  const {data, size} = encode(address, {border: 4, ecc: 'M'});
  const path = data.flatMap((row, y) => row.map((dark, x) => dark ? `M${x},${y}h1v1h-1z` : '')).join('');
  return <svg class="code" viewBox={`0 0 ${size} ${size}`} width="240" height="240" role="img" aria-label="A code for the camera of your phone; it opens the page that records." shape-rendering="crispEdges">
    <rect width={size} height={size} fill="#ffffff" /><path d={path} fill="#000000" />
  </svg>;
}
