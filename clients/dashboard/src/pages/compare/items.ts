// What can be compared, by the words of the address: a recording's channel (rec_…:gz), a fit (fit_…), a condition of a device's axis
// (phone-07~static~gyroscope~z), a simulation model beside a recording's channel (mod_…~rec_…~gz, or mod_… alone beside the recording that
// it was made of), and what a data sheet states (sheet~L3G4200D~gyroscope).
import {useRead, type Problem} from '../../api/client';
import type {Channel, Characterisation, Implied, List, ModelFit, Quantity, Recording} from '../../api/documents';
import {conditionName, conditionText, processName, sensorOf, spaced, symbolOf} from '../../format/words';
import type {DataSheetDocument} from '../datasheet/documents';
import {columnName, type ParameterTable} from '../device/documents';

interface StoredFit extends ModelFit { recording: string; channel: string }
type Processes = readonly {process: string; params: Record<string, Quantity | null>}[];
interface SimulationModel { name: string; device: string | null; effects: {cause: string; params: Record<string, Quantity>; channels?: string[]}[]; provenance: {recordings?: {id: string}[]} }
export interface ImpliedByModel { processes: Processes; left_out: string[]; implied: Implied }
// A parameter that is a part of it and was not identified is null; one that is no part of it is not there.
export type Parameters = ReadonlyMap<string, Quantity | null>;
// `given`: its parameters are stated, not estimated; `channel` is null where it has no curve.
export interface Item {
  key: string; name: string; named: string; device: string; recording: string; quantity: string; unit: string; axis: string | null; channel: Channel | null; given: boolean;
  fits: readonly (readonly [string, string])[]; channels: readonly (readonly [string, string])[];
  model: string | undefined; parameters: Parameters; implied: Implied | null; leftOut: readonly string[];
}
// `said`: what it is called until it is known; `lacks`: why it will not be.
export interface Slot { item: Item | null; problem: Problem | undefined; again: () => void; said: string; lacks: string | undefined }

export const conditionKey = (device: string, condition: string, sensor: string, axis: string): string => [device, condition, sensor, axis].map(encodeURIComponent).join('~');

function parametersOf(processes: Processes): Map<string, Quantity | null> {
  const found = new Map<string, Quantity | null>();
  const seen = new Map<string, number>();
  for (const process of processes) {
    const nth = (seen.get(process.process) ?? 0) + 1;
    seen.set(process.process, nth);
    for (const [name, quantity] of Object.entries(process.params)) found.set(`${processName(process.process)}${nth > 1 ? ` ${nth}` : ''} ${symbolOf(name)}`, quantity);
  }
  return found;
}

function parametersIn(values: Record<string, Quantity | null>): Parameters {
  return new Map(Object.entries(values).map(([key, quantity]) => {
    const {process, symbol} = columnName(key);
    return [`${process.startsWith('Gauss') ? process : process.toLowerCase()} ${symbol}`, quantity] as const;
  }));
}

// The effects of a model on a channel that its curve does not hold.
function effectsOf(model: SimulationModel, channel: string, leftOut: readonly string[]): [string, Quantity][] {
  return model.effects.filter(effect => leftOut.includes(effect.cause) && (!effect.channels?.length || effect.channels.includes(channel)))
    .flatMap(effect => Object.entries(effect.params).map(([name, quantity]): [string, Quantity] => [`${spaced(effect.cause)} ${symbolOf(name)}`, quantity]));
}

// One place of the comparison; `key` is empty where there is none.
export function useSlot(key: string): Slot {
  const parts = key.split('~').map(decodeURIComponent);
  const isFit = key.startsWith('fit_');
  const isModel = key.startsWith('mod_');
  const isSheet = parts[0] === 'sheet' && parts.length === 3;
  const [device = '', condition = '', sensor = '', axis = ''] = parts.length === 4 ? parts : [];
  const fit = useRead<StoredFit>(isFit ? `/v1/fits/${key}` : null);
  const model = useRead<SimulationModel>(isModel ? `/v1/models/${parts[0]}` : null);
  const sheets = useRead<List<DataSheetDocument>>(isSheet ? `/v1/data-sheets?model=${encodeURIComponent(parts[1]!)}` : null);
  const table = useRead<ParameterTable>(device ? `/v1/parameter-tables?${new URLSearchParams({device, sensor, axis})}` : null);
  const row = table.data?.rows.find(one => conditionText(one.condition) === condition);
  const [own = '', column = ''] = isModel ? parts.slice(1) : key.startsWith('rec_') ? key.split(':') : [];
  const id = own || fit.data?.recording || row?.recordings[0] || model.data?.provenance.recordings?.[0]?.id;
  const result = useRead<Characterisation>(id ? `/v1/recordings/${id}/characterisation` : null);
  const recording = useRead<Recording>(id ? `/v1/recordings/${id}` : null);
  const wanted = fit.data?.channel ?? column;
  const one = device ? result.data?.channels.find(each => each.result.axis === axis && sensorOf(each.result.quantity) === sensor)
    : result.data?.channels.find(each => each.result.channel === wanted || each.result.axis === wanted) ?? result.data?.channels[0];
  const curve = useRead<Partial<ImpliedByModel> & {implied: Implied | null}>(isFit ? `/v1/fits/${key}/implied` : isModel && id && one ? `/v1/models/${parts[0]}/implied?${new URLSearchParams({recording: id, channel: one.result.channel})}` : null);
  const {problem, again} = [fit, model, sheets, curve, table, result, recording].find(read => read.problem) ?? fit;
  // Names that the daemon gives to models end with the id of a study.
  const modelName = model.data?.name.replace(/ of stu_\w+$/, '');
  const said = device ? [device, condition.replace(/^\w+:/, '').replace(/:/g, ' '), axis].join(' ') : isSheet ? `${parts[1]}, data sheet` : modelName ?? key;
  const stated = sheets.data?.items.find(each => each.name === parts[1])?.sensors.find(each => each.sensor === parts[2]);
  const lacks = key && !isFit && !isModel && !isSheet && !device && !own ? `${said} is nothing that can be compared.`
    : model.data && !id ? `${said} is drawn at the times of a recording: add one first, then the model.`
    : sheets.data && !stated?.N ? `${said} states no noise of the ${parts[2]}.`
    : table.data && !row || result.data && !one ? `${said} has no result.` : undefined;
  const nothing = {item: null, problem, again, said, lacks};
  if (stated?.N) {
    const quantity = parts[2] === 'gyroscope' ? 'angular_rate' : 'specific_force';
    return {problem, again, said, lacks, item: {key, name: said, named: said, device: '', recording: '', quantity, unit: stated.unit, axis: null, channel: null, given: true, fits: [], channels: [], model: undefined, parameters: new Map([['white noise N', stated.N]]), implied: null, leftOut: []}};
  }
  if (!one || !recording.data || isFit && !curve.data || isModel && !(curve.data && model.data)) return nothing;
  const {result: channel} = one;
  const best = fit.data ?? channel.fits[0];
  const leftOut = curve.data?.left_out ?? [];
  const parameters = isModel ? new Map([...parametersOf(curve.data!.processes!), ...effectsOf(model.data!, channel.channel, leftOut)]) : row ? parametersIn(row.values) : parametersOf(best?.processes ?? []);
  return {problem, again, said, lacks, item: {
    key, channel, recording: recording.data.id, quantity: channel.quantity, unit: channel.unit, axis: channel.axis, device: recording.data.device, given: isModel, parameters, leftOut,
    named: model.data?.name ?? recording.data.metadata.id ?? recording.data.file.name ?? recording.data.id,
    name: modelName ? `${modelName} ${channel.axis ?? ''}` : [conditionName(recording.data.metadata.condition, channel.axis), channel.axis ?? '', isFit ? best?.model : ''].filter(Boolean).join(' '),
    model: isModel ? undefined : row ? table.data!.model ?? undefined : best?.model, implied: curve.data?.implied ?? null,
    channels: own ? result.data!.channels.map(({result: {channel: name}}) => [isModel ? [parts[0]!, own, name].map(encodeURIComponent).join('~') : `${own}:${name}`, name] as const) : [],
    fits: row || isModel ? [] : [[`${recording.data.id}:${channel.channel}`, 'as measured'], ...channel.fits.map((each, i) => [one.fit_ids[i] ?? '', each.model] as const)],
  }};
}

// The names of items, of which no two are the same: with the device where there are several, with the recording where that does not tell
// them apart, and numbered where nothing does.
export function nameApart(items: readonly Item[], deviceName: (id: string) => string): void {
  const several = new Set(items.flatMap(item => item.device || [])).size > 1;
  const same = (item: Item): Item[] => items.filter(other => other.name === item.name);
  for (const item of items) if (several && item.device) item.name = `${deviceName(item.device)} ${item.name}`.trim();
  for (const item of items.filter(item => same(item).length > 1)) item.name = `${item.named}${item.implied && item.model ? ` ${item.model}` : ''}`;
  for (const item of items) { const alike = same(item); if (alike.length > 1) alike.forEach((each, i) => { each.name += ` (${i + 1})`; }); }
}
