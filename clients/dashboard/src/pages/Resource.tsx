// Studies, models and calibrations as they are stored: every id has a page.
import type {JSX} from 'preact';
import {useRead} from '../api/client';
import {usePlace} from '../route';
import {Head} from '../shell/Head';
import {copy, curlOf} from '../shell/copy';
import {Panel, Shown} from '../shell/states';
import {useTitle} from '../shell/title';

const ONE: Record<string, string> = {studies: 'Study', models: 'Model', calibrations: 'Calibration'};

export default function Resource(): JSX.Element {
  const {parts} = usePlace();
  const [kind = '', id = ''] = parts;
  const path = `/v1/${kind}/${encodeURIComponent(id)}`;
  const read = useRead<{parent?: string | null}>(path);
  const title = `${ONE[kind] ?? kind} ${id}`;
  useTitle(title);
  return <>
    <Head title={title} facts={['as the API gives it']} actions={kind === 'models' && read.data && <a class="btn" href={`/compare?with=${[read.data.parent, id].filter(Boolean).join(',')}`}>Compare</a>} />
    <Panel title="Document" tools={<div class="tools"><a href={path}>JSON</a><button type="button" class="quiet" onClick={() => copy(curlOf(path), 'The command is')}>curl</button></div>}>
      <Shown read={read}>{document => <pre tabIndex={0}>{JSON.stringify(document, null, 2)}</pre>}</Shown>
    </Panel>
  </>;
}
