import type {JSX} from 'preact';
import {useRef, useState} from 'preact/hooks';
import {droppedOf, type Dropped} from '../../shell/drops';

// Files of a drop, with those of folders in it.
export async function filesOf({entries, files}: Dropped): Promise<File[]> {
  if (entries.length === 0) return files;
  const found: File[] = [];
  const walk = async (entry: FileSystemEntry): Promise<void> => {
    if (entry.isFile) {
      found.push(await new Promise<File>((resolve, reject) => (entry as FileSystemFileEntry).file(resolve, reject)));
    } else {
      const reader = (entry as FileSystemDirectoryEntry).createReader();
      for (;;) {
        const more = await new Promise<FileSystemEntry[]>((resolve, reject) => reader.readEntries(resolve, reject));
        if (more.length === 0) return;
        for (const each of more) await walk(each);
      }
    }
  };
  for (const entry of entries) await walk(entry);
  return found;
}

export function DropZone({onFiles, onSample, tall}: {onFiles: (files: File[]) => void; onSample?: () => void; tall?: boolean}): JSX.Element {
  const [over, setOver] = useState(false);
  const chooser = useRef<HTMLInputElement>(null);
  return <div class={`drop${over ? ' over' : ''}${tall ? ' tall' : ''}`}
    onDragOver={event => { event.preventDefault(); setOver(true); }} onDragLeave={() => setOver(false)}
    onDrop={event => { event.preventDefault(); setOver(false); if (event.dataTransfer) void filesOf(droppedOf(event.dataTransfer)).then(onFiles); }}>
    <svg width="26" height="26" viewBox="0 0 26 26" aria-hidden="true"><path d="M3 17v6h20v-6M13 18V4M7 10l6-6 6 6" fill="none" stroke="var(--ink)" stroke-width="1.8" /></svg>
    <div class={tall ? '' : 'grow'}><b>Drop recordings, a folder or a study.json here</b><div class="sec">CSV, npy, npz, MATLAB, phyphox and Sensor Logger exports, board logs; gzip, xz or zstd.</div></div>
    <div class="actions">
      <button type="button" class={`btn${tall ? ' primary' : ''}`} onClick={() => chooser.current?.click()}>Choose files</button>
      <input ref={chooser} type="file" multiple class="visually-hidden" tabIndex={-1} aria-label="Recordings" onChange={event => { onFiles([...event.currentTarget.files ?? []]); event.currentTarget.value = ''; }} />
      <a class="btn" href="/record">Record this phone</a>
      {onSample && <button type="button" class="btn" onClick={onSample}>Try the sample</button>}
    </div>
  </div>;
}
