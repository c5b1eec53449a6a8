// Recorded drives, and what was asked of them.
import type {JSX} from 'preact';
import {useRead} from '../api/client';
import type {List} from '../api/documents';
import {writeWhen} from '../format/time';
import {pageOf, usePlace} from '../route';
import {Head} from '../shell/Head';
import {Pager} from '../shell/Pager';
import {Panel, Shown} from '../shell/states';
import {Tabs} from '../shell/Tabs';
import {useTitle} from '../shell/title';
import type {EvaluationRow, StoredDrive} from './drive/documents';
import {Evaluations} from './drive/Evaluations';

const RECENT = 20;

function Wanted({drive}: {drive: StoredDrive['drive']}): JSX.Element {
  const {outages} = drive;
  return <>{outages?.at ? `${outages.at.length} given` : `${(outages?.duration_s ?? [10, 30, 60]).join(', ')} s`}</>;
}

export default function Drives(): JSX.Element {
  const {query} = usePlace();
  useTitle('Drives');
  const after = query.get('after');
  const drives = useRead<List<StoredDrive>>(`/v1/drives?sort=-created_at&limit=50${after ? `&cursor=${after}` : ''}`, 5000);
  const asked = useRead<List<EvaluationRow>>(`/v1/drive-evaluations?sort=-created_at&limit=${RECENT}`, 5000);
  return <>
    <Head title="Recorded drives" facts={['measured outages against simulated ones']} />
    <Tabs group="outages" />
    <Shown read={drives}>{list => list.items.length === 0 && !after
      ? <Panel title="None yet"><p>A drive is one recording of an inertial unit with GNSS fixes and a reference. The filter runs on it with the error model that you give, fixes are taken away, and the measured errors are set beside those that the model promises. The command line uploads the files of a <code>drive.json</code> and asks:</p>
        <pre tabIndex={0}><code>{`driftlab drive simulate drive.json --server ${window.location.origin}`}</code></pre><p><a href="/docs/drives">How a drive is described</a></p></Panel>
      : <div class="grid two">
        <Panel title="Drives" sub="newest first"><div class="scroll"><table class="stacked">
          <thead><tr><th scope="col">drive</th><th scope="col">vehicle</th><th scope="col">outages of</th><th scope="col">stored</th></tr></thead>
          <tbody>{list.items.map(each => <tr key={each.id}><th scope="row"><a href={pageOf('drives', each.id)}>{each.name}</a></th><td class="sec">{each.vehicle}</td><td class="sec"><Wanted drive={each.drive} /></td><td class="sec nowrap">{writeWhen(each.created_at)}</td></tr>)}</tbody></table></div>
          <Pager next={list.next_cursor} />
        </Panel>
        <Panel title="Asked of them" sub="newest first"><Shown read={asked}>{rows => rows.items.length === 0 ? <p class="sec">Nothing yet. A drive’s page asks.</p> : <Evaluations rows={rows.items} named />}</Shown></Panel>
      </div>}</Shown>
  </>;
}
