// The dashboard: which page an address shows.
import {render, type JSX} from 'preact';
import {useEffect, useRef, useState} from 'preact/hooks';
import {useLocked} from './api/client';
import Absent from './pages/Absent';
import './routes/shell';
import {followLinks, usePlace} from './route';
import {Bar} from './shell/Bar';
import {Drawer} from './shell/Drawer';
import {startDrops} from './shell/drops';
import {openKeys} from './shell/Help';
import {startKeys} from './shell/keys';
import {Said} from './shell/say';
import {SignIn} from './shell/SignIn';
import {Hairlines} from './shell/states';
import {startTheme} from './shell/theme';

declare const DRIFTLAB_VERSION: string;
const VERSION = DRIFTLAB_VERSION;

type Page = () => JSX.Element;
type Load = () => Promise<Page>;

// Pages come in few files: each alone would pack far worse. What they share is in the shell's (routes/shell.ts) or with the figures.
const lists = (pick: (pages: typeof import('./routes/lists')) => Page): Load => () => import('./routes/lists').then(pick);
const measured = (pick: (pages: typeof import('./routes/measured')) => Page): Load => () => import('./routes/measured').then(pick);
const results = (pick: (pages: typeof import('./routes/results')) => Page): Load => () => import('./routes/results').then(pick);

const PAGES: Record<string, Load> = {
  '': () => import('./routes/lab').then(pages => pages.Lab),
  devices: lists(pages => pages.Devices),
  'devices/*': measured(pages => pages.Device),
  'recordings/*': measured(pages => pages.Recording),
  compare: measured(pages => pages.Compare),
  investigations: lists(pages => pages.Investigations),
  'investigations/*': results(pages => pages.Investigation),
  outages: lists(pages => pages.Outages),
  'outages/new': lists(pages => pages.Outages),
  'outages/*': results(pages => pages.Outage),
  drives: lists(pages => pages.Drives),
  'drives/*': lists(pages => pages.Drive),
  'drive-evaluations/*': results(pages => pages.DriveEvaluation),
  populations: lists(pages => pages.Populations),
  'populations/*': measured(pages => pages.Population),
  'data-sheets': lists(pages => pages.DataSheets),
  'data-sheets/*': lists(pages => pages.DataSheet),
  webhooks: lists(pages => pages.Webhooks),
  'webhooks/*': lists(pages => pages.Webhook),
  jobs: lists(pages => pages.Jobs),
  'jobs/new': lists(pages => pages.RunAgain),
  'jobs/*': lists(pages => pages.Job),
  upload: lists(pages => pages.Upload),
  record: () => import('./routes/record').then(pages => pages.Record),
  regressions: results(pages => pages.Regressions),
  'regressions/*': results(pages => pages.Regression),
  docs: lists(pages => pages.Docs),
  'docs/*': lists(pages => pages.Docs),
  'problems/*': lists(pages => pages.Docs),
  'models/*': lists(pages => pages.Resource),
  'studies/*': lists(pages => pages.Resource),
  'calibrations/*': lists(pages => pages.Resource),
};
const absent: Load = () => Promise.resolve(Absent);

function App(): JSX.Element {
  const place = usePlace();
  const whole = place.parts.join('/');
  const key = PAGES[whole] ? whole : place.parts.length > 1 ? `${place.parts[0]}/*` : place.parts[0] ?? '';
  const [shown, setShown] = useState<{key: string; Page: Page} | null>(null);
  const main = useRef<HTMLElement>(null);
  const first = useRef(true);
  useEffect(() => {
    let current = true;
    (place.parts.length > 2 ? absent : PAGES[key] ?? absent)().then(Page => { if (current) setShown({key, Page}); }, () => window.location.reload());
    return () => { current = false; };
  }, [key]);
  useEffect(() => {
    if (first.current) { first.current = false; return; }
    main.current?.focus({preventScroll: true});
  }, [place.path]);
  if (useLocked()) return <SignIn />;
  const Page = shown?.key === key ? shown.Page : null;
  return <>
    <Bar />
    <main id="main" tabIndex={-1} ref={main} data-source={`${window.location.href.replace(/[?&]print=1/, '')}, driftlab ${VERSION}, ${new Date().toISOString().slice(0, 16).replace('T', ' ')} UTC`}>{Page ? <Page key={place.path} /> : <Hairlines />}</main>
    <Drawer />
    <Said />
  </>;
}

startTheme();
startDrops();
followLinks();
startKeys(openKeys);
const root = document.getElementById('page')!;
root.textContent = '';
render(<App />, root);
