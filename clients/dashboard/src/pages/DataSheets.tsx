// What manufacturers state of their sensors, all of it in one list.
import type {JSX} from 'preact';
import {useRead} from '../api/client';
import type {List} from '../api/documents';
import {plural, writeUnit} from '../format/words';
import {hover, pageOf, usePlace} from '../route';
import {Head} from '../shell/Head';
import {Panel, Shown} from '../shell/states';
import {Tabs} from '../shell/Tabs';
import {useTitle} from '../shell/title';
import {writeStated, type DataSheetDocument, type SensorSheet, type Stated} from './datasheet/documents';

const letters = (text: string): string => text.toLowerCase().replace(/[^a-z0-9]/g, '');

// As a person types it: case, spaces and hyphens do not matter.
function matches(sheet: DataSheetDocument, wanted: string): boolean {
  return [sheet.name, sheet.manufacturer, sheet.document, ...sheet.also].some(text => letters(text).includes(letters(wanted)));
}

// What is not stated takes no line on a phone.
const Cell = ({label, stated}: {label: string; stated: Stated | undefined}): JSX.Element => stated ? <td data-label={label} class="nowrap">{writeStated(stated.value)} {writeUnit(stated.unit)}</td> : <td class="desk-only">–</td>;
const of = (sheet: DataSheetDocument, sensor: SensorSheet['sensor']): SensorSheet | undefined => sheet.sensors.find(each => each.sensor === sensor);

export default function DataSheets(): JSX.Element {
  const {query} = usePlace();
  useTitle('Data sheets');
  const wanted = query.get('q') ?? '';
  const read = useRead<List<DataSheetDocument>>('/v1/data-sheets');
  const shown = read.data?.items.filter(sheet => matches(sheet, wanted)) ?? [];
  return <>
    <Head title="Data sheets" facts={['what manufacturers state of their sensors', read.data && plural(read.data.items.length, 'sensor')]}
      actions={<input type="search" aria-label="Find a sensor or manufacturer" placeholder="Find a sensor, manufacturer" value={wanted} onInput={event => hover({q: event.currentTarget.value || null})} />} />
    <Tabs group="devices" />
    <Panel title="Sensors" sub="N: the stated noise as the N of a parameter table"><Shown read={read}>{() => shown.length === 0 ? <p class="sec">No sensor known here has “{wanted}” in its name, manufacturer or document. <a href="/docs/data-sheets">How sensors are recognised</a></p> : <div class="scroll"><table class="stacked">
      <thead><tr><th scope="col">sensor</th><th scope="col">manufacturer</th><th scope="col">gyroscope N</th><th scope="col">bias stability</th><th scope="col">accelerometer N</th><th scope="col">bias stability</th><th scope="col">document</th></tr></thead>
      <tbody>{shown.map(sheet => { const [gyro, force] = [of(sheet, 'gyroscope'), of(sheet, 'accelerometer')]; return <tr key={sheet.name}>
        <th scope="row"><a href={pageOf('data-sheets', sheet.name)}>{sheet.name}</a></th><td class="sec">{sheet.manufacturer}</td>
        <Cell label="gyroscope N" stated={gyro?.N} /><Cell label="bias stability" stated={gyro?.bias_stability} /><Cell label="accelerometer N" stated={force?.N} /><Cell label="bias stability" stated={force?.bias_stability} />
        <td class="sec">{sheet.document}</td></tr>; })}</tbody></table></div>}</Shown></Panel>
  </>;
}
