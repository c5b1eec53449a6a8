// One data sheet: every figure with where it stands.
import type {JSX} from 'preact';
import {useRead} from '../api/client';
import type {List} from '../api/documents';
import {writeTick} from '../format/number';
import {capital, writeUnit} from '../format/words';
import {listOf, pageOf, usePlace} from '../route';
import {Head} from '../shell/Head';
import {copy, curlOf} from '../shell/copy';
import {Panel, Shown} from '../shell/states';
import {useTitle} from '../shell/title';
import {sourceOf, writeStated, type DataSheetDocument, type SensorSheet, type Stated} from './datasheet/documents';

function Row({name, stated, note}: {name: string; stated: Stated | undefined; note?: string}): JSX.Element | null {
  if (!stated) return null;
  return <tr><th scope="row">{name}{note && <div class="u">{note}</div>}</th><td class="n"><b>{writeStated(stated.value)}</b></td><td class="u">{writeUnit(stated.unit)}</td></tr>;
}

function Range({name, ends, unit}: {name: string; ends: number[] | undefined; unit: string}): JSX.Element | null {
  if (!ends) return null;
  const [low, high] = ends;
  return <tr><th scope="row">{name}</th><td class="n nowrap"><b>{low === high ? writeTick(low ?? 0) : `${writeTick(low ?? 0)} to ${writeTick(high ?? 0)}`}</b></td><td class="u">{unit}</td></tr>;
}

function Sensor({sheet}: {sheet: SensorSheet}): JSX.Element {
  return <Panel title={capital(sheet.sensor)} sub={sheet.place}>
    <table class="params"><caption class="visually-hidden">Stated figures of the {sheet.sensor}</caption><tbody>
      <Row name="Noise density" stated={sheet.noise_density} /><Row name="Noise density of z" stated={sheet.noise_density_z} /><Row name="Random walk" stated={sheet.random_walk} />
      <Row name="N, to compare with" stated={sheet.N} note={sheet.random_walk ? 'the stated random walk' : 'the stated density, taken as one-sided, over √2'} />
      <Row name="In-run bias stability" stated={sheet.bias_stability} note="the lowest point of the Allan deviation, 0.664 B" />
      <Range name="Bandwidth" ends={sheet.bandwidth_hz} unit="Hz, −3 dB" /><Range name="Output rate" ends={sheet.rate_hz} unit="Hz" />
      {sheet.full_scales.map((scale, i) => <tr key={i}><th scope="row">{i === 0 ? 'Ranges' : <span class="visually-hidden">Range</span>}</th><td class="n"><b>± {writeTick(scale.limit)}</b></td><td class="u">{writeUnit(sheet.unit)}{scale.per_count !== undefined ? `, ${writeStated(scale.per_count)} a count` : ''}</td></tr>)}
    </tbody></table>
  </Panel>;
}

export default function DataSheet(): JSX.Element {
  const {parts} = usePlace();
  const name = parts[1] ?? '';
  const path = `/v1/data-sheets?model=${encodeURIComponent(name)}`;
  const read = useRead<List<DataSheetDocument>>(path);
  useTitle(name);
  return <Shown read={read} page="Data sheet">{list => { const sheet = list.items.find(each => each.name === name) ?? list.items[0]; return !sheet
    ? <><Head crumb={[['Data sheets', listOf('data-sheets')], [name, null]]} title={name} facts={[]} /><p class="verdict">No known sensor is named in this text. <a href="/docs/data-sheets">How sensors are recognised</a></p></>
    : <>
      <Head crumb={[['Data sheets', listOf('data-sheets')], [sheet.name, null]]} title={sheet.name} facts={[sheet.manufacturer, sheet.also.length > 0 && `also ${sheet.also.join(', ')}`]}
        actions={<><a class="btn" href={pageOf('populations', sheet.name)}>Devices of this model</a><button type="button" class="btn" onClick={() => copy(curlOf(path), 'The command is')}>curl</button></>} />
      <p class="sec">Source: {sourceOf(sheet)}. What the document does not state is absent; the figures are typical ones. <a href="/docs/data-sheets">How they are compared with what is measured</a></p>
      <div class="grid two">{sheet.sensors.map(each => <Sensor key={each.sensor} sheet={each} />)}</div>
    </>; }}</Shown>;
}
