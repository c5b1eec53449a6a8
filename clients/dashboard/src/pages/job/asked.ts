// What a person would send to queue a job's work again: its inputs as they are asked for, without what the daemon wrote beside them.
import type {Job} from '../../api/documents';

export interface Asked { kind: string; inputs: Record<string, unknown>; parameters: Record<string, unknown> }

type Pinned = Record<string, unknown>;
// Of a recording of a regression; its results are pinned anew.
const OF_RECORDING = ['recording', 'session', 'recorded_at', 'temperature_degc', 'full_scale', 'causes'];

const some = (from: Pinned, names: readonly string[]): Pinned => Object.fromEntries(names.flatMap(name => from[name] === undefined || from[name] === null ? [] : [[name, from[name]]]));

// `firmware=1.4.2, board=b`, as an arm is called, are its labels.
function arm({label, recordings}: {label?: string | null; recordings?: Pinned[]}): Pinned {
  const labels = (label ?? '').split(', ').map(each => each.split('=')).filter(each => each.length === 2);
  return {...(labels.length > 0 ? {labels: Object.fromEntries(labels) as unknown} : {}), recordings: (recordings ?? []).map(one => some(one, OF_RECORDING))};
}

export function asked({kind, request}: Job): Asked {
  const {inputs, parameters} = request;
  const of = (): Pinned => {
    if (inputs.study) return {study: inputs.study};
    if (kind === 'outage_evaluation') return {scenario: inputs.scenario};
    if (kind === 'drive_evaluation') return {drive: inputs.drive, ...some(inputs.document ?? {}, ['model', 'outages'])};
    if (kind === 'regress') return {device: inputs.device, baseline: arm(inputs.baseline ?? {}), candidate: arm(inputs.candidate ?? {}), ...((inputs.excluded ?? []).length > 0 ? {excluded: inputs.excluded} : {})};
    return inputs.recordings ? {recordings: inputs.recordings.map(one => one.id)} : {...inputs};
  };
  return {kind, inputs: of(), parameters: parameters as Pinned};
}
