// What can be compared, by the words of the address: a recording's channel (rec_…:gz), a fit (fit_…), or a condition of a device's axis
// (phone-07~static~gyroscope~z).
import {useRead, type Problem} from '../../api/client';
import type {Channel, Characterisation, Implied, ModelFit, Quantity, Recording} from '../../api/documents';
import {conditionName, conditionText, processName, sensorOf, symbolOf} from '../../format/words';
import {columnName, type ParameterTable} from '../device/documents';

interface StoredFit extends ModelFit { recording: string; channel: string }
export type Parameters = ReadonlyMap<string, Quantity>;
export interface Item {
  key: string; name: string; named: string; device: string; channel: Channel; fits: readonly (readonly [string, string])[]; channels: readonly string[];
  model: string | undefined; parameters: Parameters; implied: Implied | null;
}
// `said`: what it is called until it is known; `lacks`: why it will not be.
export interface Slot { item: Item | null; problem: Problem | undefined; said: string; lacks: string | undefined }

export const conditionKey = (device: string, condition: string, sensor: string, axis: string): string => [device, condition, sensor, axis].map(encodeURIComponent).join('~');

function parametersOf(processes: readonly {process: string; params: Record<string, Quantity | null>}[]): Parameters {
  const found = new Map<string, Quantity>();
  const seen = new Map<string, number>();
  for (const process of processes) {
    const nth = (seen.get(process.process) ?? 0) + 1;
    seen.set(process.process, nth);
    for (const [name, quantity] of Object.entries(process.params)) if (quantity) found.set(`${processName(process.process)}${nth > 1 ? ` ${nth}` : ''} ${symbolOf(name)}`, quantity);
  }
  return found;
}

function parametersIn(values: Record<string, Quantity | null>): Parameters {
  return new Map(Object.entries(values).flatMap(([key, quantity]) => {
    const {process, symbol} = columnName(key);
    const name = process.startsWith('Gauss') ? process : process.toLowerCase();
    return quantity ? [[`${name} ${symbol}`, quantity] as const] : [];
  }));
}

// One place of the comparison; `key` is empty where there is none.
export function useSlot(key: string): Slot {
  const isFit = key.startsWith('fit_');
  const [device = '', condition = '', sensor = '', axis = ''] = key.includes('~') ? key.split('~').map(decodeURIComponent) : [];
  const fit = useRead<StoredFit>(isFit ? `/v1/fits/${key}` : null);
  const implied = useRead<{implied: Implied | null}>(isFit ? `/v1/fits/${key}/implied` : null);
  const table = useRead<ParameterTable>(device ? `/v1/parameter-tables?${new URLSearchParams({device, sensor, axis})}` : null);
  const row = table.data?.rows.find(one => conditionText(one.condition) === condition);
  const [own = '', column = ''] = key.startsWith('rec_') ? key.split(':') : [];
  const id = own || fit.data?.recording || row?.recordings[0];
  const result = useRead<Characterisation>(id ? `/v1/recordings/${id}/characterisation` : null);
  const recording = useRead<Recording>(id ? `/v1/recordings/${id}` : null);
  const wanted = fit.data?.channel ?? column;
  const one = device ? result.data?.channels.find(each => each.result.axis === axis && sensorOf(each.result.quantity) === sensor)
    : result.data?.channels.find(each => each.result.channel === wanted || each.result.axis === wanted) ?? result.data?.channels[0];
  const problem = fit.problem ?? implied.problem ?? table.problem ?? result.problem;
  const said = device ? [device, condition.replace(/^\w+:/, '').replace(/:/g, ' '), axis].join(' ') : key;
  const lacks = table.data && !row || result.data && !one ? `${said} has no result.` : undefined;
  if (!one || !recording.data || isFit && !implied.data) return {item: null, problem, said, lacks};
  const {result: channel} = one;
  const best = fit.data ?? channel.fits[0];
  return {problem, said, lacks, item: {
    key, channel, device: recording.data.device, named: recording.data.metadata.id ?? recording.data.file.name ?? recording.data.id,
    name: [conditionName(recording.data.metadata.condition, channel.axis), channel.axis ?? '', isFit ? best?.model : ''].filter(Boolean).join(' '),
    model: row ? table.data!.model ?? undefined : best?.model, parameters: row ? parametersIn(row.values) : parametersOf(best?.processes ?? []), implied: implied.data?.implied ?? null,
    channels: own ? result.data!.channels.map(each => each.result.channel) : [],
    fits: row ? [] : [[`${recording.data.id}:${channel.channel}`, 'as measured'], ...channel.fits.map((each, i) => [one.fit_ids[i] ?? '', each.model] as const)],
  }};
}

// The names of items, of which no two are the same: with the device where there are several, with the recording where that does not tell
// them apart, and numbered where nothing does.
export function nameApart(items: readonly Item[], deviceName: (id: string) => string): void {
  const several = new Set(items.map(item => item.device)).size > 1;
  const same = (item: Item): Item[] => items.filter(other => other.name === item.name);
  for (const item of items) if (several) item.name = `${deviceName(item.device)} ${item.name}`.trim();
  for (const item of items.filter(item => same(item).length > 1)) item.name = `${item.named}${item.implied ? ` ${item.model}` : ''}`;
  for (const item of items) { const alike = same(item); if (alike.length > 1) alike.forEach((each, i) => { each.name += ` (${i + 1})`; }); }
}
