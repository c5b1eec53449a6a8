// The dashboard: which page an address shows.
import {render, type JSX} from 'preact';
import {useEffect, useRef, useState} from 'preact/hooks';
import {useLocked} from './api/client';
import {followLinks, usePlace} from './route';
import {Bar} from './shell/Bar';
import {Drawer, openDrawer} from './shell/Drawer';
import {Keys} from './shell/Help';
import {startKeys} from './shell/keys';
import {Said} from './shell/say';
import {SignIn} from './shell/SignIn';
import {Hairlines} from './shell/states';
import {startTheme} from './shell/theme';

declare const DRIFTLAB_VERSION: string;
const VERSION = DRIFTLAB_VERSION;

type Page = () => JSX.Element;
const PAGES: Record<string, () => Promise<{default: Page}>> = {
  '': () => import('./pages/Lab'),
  devices: () => import('./pages/Devices'),
  'devices/*': () => import('./pages/Device'),
  'recordings/*': () => import('./pages/Recording'),
  compare: () => import('./pages/Compare'),
  investigations: () => import('./pages/Investigations'),
  'investigations/*': () => import('./pages/Investigation'),
  outages: () => import('./pages/Outages'),
  'outages/*': () => import('./pages/Outage'),
  jobs: () => import('./pages/Jobs'),
  'jobs/*': () => import('./pages/Job'),
  upload: () => import('./pages/Upload'),
  record: () => import('./pages/Record'),
  regressions: () => import('./pages/Regressions'),
  'regressions/*': () => import('./pages/Regression'),
  docs: () => import('./pages/Docs'),
  'docs/*': () => import('./pages/Docs'),
  'problems/*': () => import('./pages/Docs'),
  'models/*': () => import('./pages/Resource'),
  'studies/*': () => import('./pages/Resource'),
  'calibrations/*': () => import('./pages/Resource'),
};
const absent = (): Promise<{default: Page}> => import('./pages/Absent');

function App(): JSX.Element {
  const place = usePlace();
  const key = place.parts.length > 1 ? `${place.parts[0]}/*` : place.parts[0] ?? '';
  const [shown, setShown] = useState<{key: string; Page: Page} | null>(null);
  const main = useRef<HTMLElement>(null);
  const first = useRef(true);
  useEffect(() => {
    let current = true;
    (place.parts.length > 2 ? absent : PAGES[key] ?? absent)().then(module => { if (current) setShown({key, Page: module.default}); }, () => window.location.reload());
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
followLinks();
startKeys(() => openDrawer('Keys', Keys));
const root = document.getElementById('page')!;
root.textContent = '';
render(<App />, root);
