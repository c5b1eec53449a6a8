// One upload: the request that the page sends is the one that the curl line shows.
import {Problem, type ProblemDocument} from '../../api/client';
import type {Recording} from '../../api/documents';
import type {Pending} from './pending';

export function targetOf(each: Pending): string {
  const query = new URLSearchParams({device: each.device, condition: each.condition, id: each.file.name.replace(/\.[^.]+(\.(gz|xz|zst))?$/, '')});
  if (each.rate.trim()) query.set('rate_hz', each.rate.trim());
  const columns = Object.entries(each.roles).filter(([, role]) => role.quantity).map(([name, role]) => `${name}=${role.quantity}:${role.axis}:${role.unit}`);
  if (columns.length > 0) query.set('columns', columns.join(','));
  return `/v1/recordings?${query.toString()}`;
}

export const commandOf = (each: Pending): string => `curl -H 'Content-Type: application/octet-stream' --data-binary '@${each.file.name}' '${window.location.origin}${targetOf(each)}'`;

// XMLHttpRequest tells how much has been sent; fetch does not.
export function upload(each: Pending, onShare: (share: number) => void): Promise<Recording> {
  return new Promise((resolve, reject) => {
    const request = new XMLHttpRequest();
    request.open('POST', targetOf(each));
    request.setRequestHeader('Content-Type', 'application/octet-stream');
    request.setRequestHeader('Accept', 'application/json');
    request.upload.onprogress = event => { if (event.lengthComputable) onShare(event.loaded / event.total); };
    const refused = (document: ProblemDocument): void => reject(new Problem(document));
    request.onerror = () => refused({type: '', title: 'No answer', status: 0, detail: 'The daemon does not answer; nothing was stored.', retryable: true});
    request.onload = () => {
      let document: unknown;
      try { document = JSON.parse(request.responseText); } catch { document = null; }
      if (request.status >= 200 && request.status < 300) resolve(document as Recording);
      else refused((document as ProblemDocument | null) ?? {type: '', title: '', status: request.status, detail: `The daemon answered ${request.status}.`});
    };
    request.send(each.file);
  });
}
