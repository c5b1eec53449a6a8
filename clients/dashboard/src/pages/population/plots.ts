// The places of all devices in one population as a figure draws them.
import {writeTick} from '../../format/number';
import {writeUnit} from '../../format/words';
import type {Plot, Series} from '../../figure/spec';
import type {PlaceOf, PopulationRow} from './documents';

const NAMES_FIT = 44;  // letters of all names together that find room below the axis
const MOST_TICKS = 12;

function ticksOf(count: number): number[] {
  const step = [1, 2, 5, 10, 20, 50, 100, 200, 500].find(each => count / each <= MOST_TICKS) ?? 1000;
  const ticks = [];
  for (let place = step; place <= count; place += step) ticks.push(place);
  return ticks;
}

// `places` in the order in which they are drawn, `stated` by the data sheet in the population's unit.
export function placesPlot(row: PopulationRow, places: readonly PlaceOf[], stated: number | null): Plot {
  const x = places.map((_, i) => i + 1);
  const unit = writeUnit(places[0]?.estimate.unit);
  const [from, to] = [0.4, places.length + 0.6];
  const end = (i: 0 | 1, outlying: boolean): (number | null)[] => places.map(place => place.outlying === outlying ? place.estimate.ci95?.[i] ?? null : null);
  const devices = (outlying: boolean): Pick<Series, 'x' | 'y' | 'low' | 'high'> => ({x, y: places.map(place => place.outlying === outlying ? place.estimate.value : null), low: end(0, outlying), high: end(1, outlying)});
  const level = (id: string, name: string, value: number, more: Partial<Series>): Series => ({id, name, x: [from, to], y: [value, value], line: true, colour: 'var(--model)', ...more});
  const series: Series[] = [{id: 'devices', name: 'device', ...devices(false), mark: 'dot', colour: 'var(--measured)'}];
  if (places.some(place => place.outlying)) series.push({id: 'outlying', name: 'not of the line', ...devices(true), mark: 'square', colour: 'var(--robust)'});
  const mean = row.mean?.value;
  const ends = row.mean?.ci95 ?? [];
  if (mean !== null && mean !== undefined) series.push(level('mean', 'mean', mean, {width: 2, low: [ends[0] ?? null, ends[0] ?? null], high: [ends[1] ?? null, ends[1] ?? null], band: 'var(--modelband)'}));
  const [low, high] = row.prediction ?? [];
  if (low !== undefined && high !== undefined) {
    series.push(level('prediction', 'prediction, 95 %', high, {width: 1, dash: '4 4', low: [low, low], high: [high, high], band: 'var(--modelband)'}));
    series.push(level('prediction-low', 'prediction, low', low, {width: 1, dash: '4 4', noKey: true}));
  }
  if (stated !== null) series.push(level('stated', 'data sheet', stated, {width: 1.6, dash: '10 3 2 3', colour: 'var(--c-rw)'}));
  const named = places.reduce((sum, place) => sum + place.device.length, 0) <= NAMES_FIT;
  return {
    id: row.parameter, height: 220, y: {scale: 'log', name: `${row.parameter}, ${unit}`},
    x: {scale: 'linear', name: named ? '' : 'place in the table', domain: [from, to], ticks: ticksOf(places.length), write: value => named ? places[value - 1]?.device ?? '' : writeTick(value)},
    series,
  };
}
