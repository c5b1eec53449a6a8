// Before the first recording: one sentence and the place to drop it.
import type {JSX} from 'preact';
import {DropZone} from './upload/DropZone';
import {go} from '../route';
import {askFor, askForSample} from './upload/run';

export function EmptyLab(): JSX.Element {
  return <>
    <h1>Lab</h1>
    <p class="verdict">Drop a recording of a sensor at rest; you get its noise model.</p>
    <DropZone tall onFiles={files => { askFor(files); go('/upload'); }} onSample={() => { askForSample(); go('/upload'); }} />
  </>;
}
