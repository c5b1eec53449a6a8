// The noise of a device in the file of another program: which program, by which convention, what is missing, the file itself.
import type {JSX} from 'preact';
import {useState} from 'preact/hooks';
import {useRead} from '../../api/client';
import type {List} from '../../api/documents';
import {save} from '../../figure/export';
import {openDrawer} from '../../shell/Drawer';
import {copy, curlOf} from '../../shell/copy';
import {Shown} from '../../shell/states';

interface Target { target: string; title: string; file: string; convention: string; source: string }
interface Exported extends Target { gaps: string[]; text: string }

function Chosen({device, target}: {device: string; target: Target}): JSX.Element {
  const path = `/v1/exports/${target.target}?device=${encodeURIComponent(device)}`;
  const read = useRead<Exported>(path, undefined);
  return <>
    <p class="sec">{target.convention}</p>
    <Shown read={read}>{found => <>
      <div class="row"><button type="button" class="btn primary" onClick={() => save(found.file, 'text/plain', found.text)}>Save {found.file}</button><button type="button" class="btn" onClick={() => copy(found.text, 'The file is')}>Copy</button><button type="button" class="quiet" onClick={() => copy(curlOf(path), 'The command is')}>curl</button></div>
      {found.gaps.length > 0 && <ul class="rows plain">{found.gaps.map(gap => <li key={gap}><span class="g warn" aria-hidden="true">△ </span>{gap}</li>)}</ul>}
      <pre class="preview" tabIndex={0}>{found.text}</pre>
      <p class="note">Convention: {found.source}. <a href="/docs/exports">The manual</a> says which model is meant and why.</p>
    </>}</Shown>
  </>;
}

function Targets({device}: {device: string}): JSX.Element {
  const read = useRead<List<Target>>('/v1/exports');
  const [name, setName] = useState('kalibr');
  return <Shown read={read}>{list => { const target = list.items.find(one => one.target === name) ?? list.items[0]; return <>
    <label>Program <select value={name} onChange={event => setName(event.currentTarget.value)}>{list.items.map(one => <option key={one.target} value={one.target}>{one.title}</option>)}</select></label>
    {target && <Chosen key={target.target} device={device} target={target} />}
  </>; }}</Shown>;
}

export function ExportModel({device}: {device: string}): JSX.Element {
  return <button type="button" class="btn" onClick={() => openDrawer(`Export the model of ${device}`, () => <Targets device={device} />)}>Export model</button>;
}
