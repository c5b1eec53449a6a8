// What the newest result of a device says, with its page; the whole sentence where the row has no room for it.
import type {JSX} from 'preact';
import type {Device} from '../api/documents';
import {writeWhen} from '../format/time';
import {writeSentence} from '../format/words';
import {pageOf} from '../route';

interface Place { href: string; recording: string | null; channel?: string | null }

// The page of a result; the API's address is the page's with /v1 before it.
export function pageOfResult({href, recording, channel}: Place): string {
  if (recording) return `${pageOf('recordings', recording)}${channel ? `?ch=${encodeURIComponent(channel)}` : ''}`;
  const [path = '', query] = href.split('?');
  const [, , group = '', id = new URLSearchParams(query).get('model') ?? ''] = path.split('/');
  return pageOf({'outage-evaluations': 'outages'}[group] ?? group, id);
}

export function LastResult({device}: {device: Device}): JSX.Element {
  const latest = device.summary?.latest;
  if (!latest) return <>not characterised</>;
  const said = latest.verdict === null ? 'characterised' : writeSentence(latest.verdict);
  return <span class="clamp" title={said}>{latest.level === 'look' && <span class="g warn" aria-hidden="true">△ </span>}{latest.level === 'wrong' && <span class="g bad" aria-hidden="true">✗ </span>}<a href={pageOfResult(latest)}>{said}</a> <span class="dim nowrap">{writeWhen(latest.at)}</span></span>;
}
