import type {JSX} from 'preact';
import {useEffect, useState} from 'preact/hooks';
import {send, useOffline, useRead} from '../api/client';
import type {Counts, Session} from '../api/documents';
import {usePlace} from '../route';
import {Find} from './Find';
import {openKeys} from './Help';

const PAGES: readonly (readonly [string, string])[] = [['/', 'Lab'], ['/devices', 'Devices'], ['/investigations', 'Investigations'], ['/outages', 'Outages'], ['/regressions', 'Regressions'], ['/jobs', 'Jobs']];
const OWNERS: Record<string, string> = {record: '/', recordings: '/devices', compare: '/devices', studies: '/devices', models: '/devices', calibrations: '/devices', populations: '/devices', 'data-sheets': '/devices', drives: '/outages', 'drive-evaluations': '/outages', webhooks: '/jobs'};

export function Mark(): JSX.Element {
  return <svg width="18" height="18" viewBox="0 0 18 18" aria-hidden="true"><path d="M1.5 3.5C5 10.5 7 13.2 9.4 13.2S13.6 11.8 16.5 7.4" fill="none" stroke-width="2" stroke-linecap="round" /></svg>;
}

function LiveJobs(): JSX.Element {
  const counts = useRead<Counts>('/v1/counts', 2000);
  const offline = useOffline();
  const jobs = counts.data?.jobs;
  const busy = jobs ? jobs.running + jobs.queued : 0;
  const text = offline ? 'no connection' : !jobs ? '' : busy === 0 ? 'No jobs running' : `${jobs.running} running${jobs.queued > 0 ? `, ${jobs.queued} waiting` : ''}`;
  return <a class="live" href="/jobs" aria-label={text || 'Jobs'}>
    <svg width="8" height="8" aria-hidden="true"><circle cx="4" cy="4" r="3.2" fill={busy > 0 ? 'var(--ink)' : 'none'} stroke={busy > 0 ? 'var(--ink)' : 'var(--ink3)'} /></svg>
    <span>{text}</span>
  </a>;
}

export function Bar(): JSX.Element {
  const place = usePlace();
  const [open, setOpen] = useState(false);
  useEffect(() => setOpen(false), [place.path]);
  const first = `/${place.parts[0] ?? ''}`;
  const current = OWNERS[place.parts[0] ?? ''] ?? first;
  return <>
    <a class="skip" href="#main">Skip to the content</a>
    <header class={open ? 'bar open' : 'bar'}>
      <a class="word" href="/" aria-label="driftlab, the lab page"><Mark />driftlab</a>
      <nav class={open ? 'open' : ''} aria-label="Pages" id="pages" onClick={() => setOpen(false)}>
        {PAGES.map(([href, name]) => <a key={href} href={href} {...(href === current ? {'aria-current': 'page' as const} : {})}>{name}</a>)}
        <button type="button" onClick={openKeys}>Settings</button>
      </nav>
      <Find />
      <LiveJobs />
      <button type="button" class="btn menu" aria-expanded={open} aria-controls="pages" onClick={() => setOpen(!open)}>Menu</button>
      <a class="btn primary" href="/upload">Upload</a>
      <SignOut />
    </header>
    <Offline />
  </>;
}

function SignOut(): JSX.Element | null {
  const session = useRead<Session>('/v1/session');
  if (session.data?.authentication !== 'session') return null;
  const signOut = (): void => { send('DELETE', '/v1/session').then(() => window.location.reload(), () => window.location.reload()); };
  return <button type="button" class="btn" title={`Signed in as ${session.data.name ?? ''}`} onClick={signOut}>Sign out</button>;
}

function Offline(): JSX.Element {
  const offline = useOffline();
  return <div role="status">{offline && <div class="offline">The daemon does not answer. Trying again in 5 s.</div>}</div>;
}
