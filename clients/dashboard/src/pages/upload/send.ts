// One upload: the request that the page sends is the one that the curl line shows.
import {ask, Problem, type ProblemDocument} from '../../api/client';
import type {Recording} from '../../api/documents';
import type {Pending} from './pending';
import {columnsOf} from './preview';

function queryOf(each: Pending): string {
  const query = new URLSearchParams({device: each.device, condition: each.condition, id: each.name ?? each.file.name.replace(/\.[^.]+(\.(gz|xz|zst))?$/, ''), file_name: each.file.name});
  if (each.rate.trim()) query.set('rate_hz', each.rate.trim());
  each.trim?.forEach((seconds, i) => { if (seconds > 0) query.set(i === 0 ? 'trim_start_s' : 'trim_end_s', String(seconds)); });
  const columns = columnsOf(each.roles);
  if (columns) query.set('columns', columns);
  return query.toString();
}

export const targetOf = (each: Pending): string => `/v1/recordings?${queryOf(each)}`;

export const commandOf = (each: Pending): string => `curl -H 'Content-Type: application/octet-stream' --data-binary '@${each.file.name}' '${window.location.origin}${targetOf(each)}'`;

const PIECE = 8 * 1024 * 1024;   // files from here on go in pieces that are kept as they arrive (tus 1.0.0)
const ATTEMPTS = 6;
const TUS = {'Tus-Resumable': '1.0.0'};
const NO_ANSWER: ProblemDocument = {type: '', title: 'No answer', status: 0, detail: 'The daemon does not answer; what it has stored stays, and the upload goes on from there.', retryable: true};

interface Sent { status: number; text: string; header: (name: string) => string | null }

// XMLHttpRequest tells how much has been sent; fetch does not.
function post(method: string, target: string, body: Blob, headers: Record<string, string>, onBytes: (bytes: number) => void, pause: AbortSignal): Promise<Sent> {
  return new Promise((resolve, reject) => {
    const request = new XMLHttpRequest();
    request.open(method, target);
    for (const [name, value] of Object.entries(headers)) request.setRequestHeader(name, value);
    request.upload.onprogress = event => { if (event.lengthComputable) onBytes(event.loaded); };
    request.onerror = () => reject(new Problem(NO_ANSWER));
    request.onabort = () => reject(new Paused());
    request.onload = () => resolve({status: request.status, text: request.responseText, header: name => request.getResponseHeader(name)});
    pause.addEventListener('abort', () => request.abort());
    request.send(body);
  });
}

export class Paused extends Error {}

function documentOf<T>(answer: Sent): T {
  let document: unknown;
  try { document = JSON.parse(answer.text); } catch { document = null; }
  if (answer.status >= 200 && answer.status < 300) return document as T;
  throw new Problem((document as ProblemDocument | null) ?? {type: '', title: '', status: answer.status, detail: `The daemon answered ${answer.status}.`});
}

// --- uploads that were begun, by the file that they are of, so that a page that was loaded again goes on
const KEY = 'driftlab-uploads';
const fingerprint = (file: File): string => [file.name, file.size, file.lastModified].join('|');
function begun(): Record<string, string> { try { return JSON.parse(localStorage.getItem(KEY) ?? '{}') as Record<string, string>; } catch { return {}; } }
function keepBegun(file: File, id: string | null): void {
  const known = begun();
  if (id) known[fingerprint(file)] = id; else delete known[fingerprint(file)];
  try { localStorage.setItem(KEY, JSON.stringify(known)); } catch { /* then it begins anew */ }
}

async function offsetOf(id: string): Promise<number | null> {
  const answer = await fetch(`/v1/uploads/${id}`, {method: 'HEAD', headers: TUS, cache: 'no-store'}).catch(() => { throw new Problem(NO_ANSWER); });
  return answer.ok ? Number(answer.headers.get('Upload-Offset')) : null;
}

async function uploadOf(file: File): Promise<{id: string; offset: number}> {
  const id = begun()[fingerprint(file)];
  const offset = id ? await offsetOf(id) : null;
  if (id && offset !== null) return {id, offset};
  const name = btoa(String.fromCharCode(...new TextEncoder().encode(file.name)));
  const made = await ask('/v1/uploads', {method: 'POST', headers: {...TUS, 'Upload-Length': String(file.size), 'Upload-Metadata': `filename ${name}`}});
  const document = await made.json() as {id: string};
  keepBegun(file, document.id);
  return {id: document.id, offset: 0};
}

// Piece by piece; where the network goes, it is asked how far the daemon is, and the upload goes on from there.
async function inPieces(each: Pending, onShare: (share: number) => void, pause: AbortSignal): Promise<Recording> {
  const {file} = each;
  let {id, offset} = await uploadOf(file);
  for (let attempt = 0; offset < file.size;) {
    try {
      const answer = await post('PATCH', `/v1/uploads/${id}`, file.slice(offset, offset + PIECE), {...TUS, 'Content-Type': 'application/offset+octet-stream', 'Upload-Offset': String(offset)}, bytes => onShare((offset + bytes) / file.size), pause);
      if (answer.status !== 204) documentOf(answer);
      offset = Number(answer.header('Upload-Offset'));
      attempt = 0;
    } catch (error) {
      if (error instanceof Paused || !(error instanceof Problem) || (error.document.status !== 0 && error.document.status !== 409 && error.document.status < 500) || ++attempt >= ATTEMPTS) throw error;
      await new Promise(resolve => setTimeout(resolve, 400 * 2 ** attempt));
      offset = await offsetOf(id) ?? offset;
    }
  }
  const made = await ask(`/v1/uploads/${id}/recording?${queryOf(each)}`, {method: 'POST', headers: {Accept: 'application/json'}});
  keepBegun(file, null);
  return await made.json() as Recording;
}

export async function upload(each: Pending, onShare: (share: number) => void, pause: AbortSignal): Promise<Recording> {
  if (each.file.size >= PIECE) return inPieces(each, onShare, pause);
  const answer = await post('POST', targetOf(each), each.file, {'Content-Type': 'application/octet-stream', Accept: 'application/json'}, bytes => onShare(bytes / each.file.size), pause);
  return documentOf<Recording>(answer);
}
