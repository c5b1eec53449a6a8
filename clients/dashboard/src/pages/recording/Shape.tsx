// How the values lie around their median, on a logarithmic height: tails and spikes show against a Gaussian core of the same width.
import type {JSX} from 'preact';
import {useMemo} from 'preact/hooks';
import type {Read} from '../../api/client';
import type {Channel, Histogram, Recording} from '../../api/documents';
import {writeCount, writeNumber} from '../../format/number';
import {writeUnit} from '../../format/words';
import {Figure} from '../../figure/Figure';
import type {Plot} from '../../figure/spec';
import {curlOf} from '../../shell/copy';
import {Panel, Shown} from '../../shell/states';
import {writePower} from './Spectrum';

function shapePlots(shape: Histogram): Plot[] {
  const edges = shape.edges ?? [];
  const counts = shape.counts ?? [];
  const middle = counts.map((_, i) => ((edges[i] ?? 0) + (edges[i + 1] ?? 0)) / 2);
  const least = 0.5;  // an empty bin has no height on a logarithmic axis
  const curve = (shape.gaussian ?? []).map(value => value >= least ? value : null);
  return [{id: 'shape', height: 150, x: {scale: 'linear', name: 'robust standard deviations from the median', domain: [-8, 8], ticks: [-6, -3, 0, 3, 6]}, y: {scale: 'log', name: 'values', domain: [least, Math.max(10, ...counts) * 2], write: writePower},
    series: [{id: 'gaussian', name: 'Gaussian core', x: middle, y: curve, line: true, colour: 'var(--robust)', width: 1.6},
      {id: 'counts', name: 'measured', x: middle, y: counts.map(count => count > 0 ? count : null), colour: 'var(--ink3)', bars: true}]}];
}

export const shapePath = (recording: Recording, column: string): string => `/v1/recordings/${recording.id}/histogram?channel=${encodeURIComponent(column)}`;

export function Shape({recording, channel, read}: {recording: Recording; channel: Channel; read: Read<Histogram>}): JSX.Element {
  const path = shapePath(recording, channel.channel);
  const plots = useMemo(() => read.data?.counts ? shapePlots(read.data) : [], [read.data]);
  const shape = read.data;
  if (!shape) return <Panel title="Shape of the noise"><Shown read={read}>{() => null}</Shown></Panel>;
  if (!shape.counts) return <Panel title="Shape of the noise"><p>{shape.reason}</p></Panel>;
  const outside = (shape.below ?? 0) + (shape.above ?? 0);
  return <Figure name={`${recording.metadata.id ?? recording.id}-${channel.axis ?? channel.channel}-shape`} title="Shape of the noise"
    describe={`Histogram of ${channel.channel} in robust standard deviations of ${writeNumber(shape.sigma ?? 0)} ${shape.unit}, against a Gaussian core; ${outside} values lie beyond eight.`}
    plots={plots} source={`driftlab, ${recording.id} ${channel.channel}, revision ${recording.revision}`} curl={curlOf(path)}
    note={<>Robust σ {writeNumber(shape.sigma ?? 0)} {writeUnit(shape.unit)}. {outside > 0 ? `${writeCount(outside)} of ${writeCount(shape.samples)} values lie beyond 8 σ.` : 'No value lies beyond 8 σ.'}</>} />;
}
