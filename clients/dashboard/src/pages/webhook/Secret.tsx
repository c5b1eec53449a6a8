// The secret of a webhook, once: it is held by this page alone and gone with it.
import type {JSX} from 'preact';
import {useEffect, useRef} from 'preact/hooks';
import {copy} from '../../shell/copy';

export function Secret({secret, onSeen}: {secret: string; onSeen: () => void}): JSX.Element {
  const box = useRef<HTMLElement>(null);
  useEffect(() => { box.current?.focus(); }, [secret]);
  return <section class="panel" ref={box} tabIndex={-1} aria-label="Secret">
    <div class="ptop"><h2>Its secret, shown this once</h2></div>
    <p>The receiver checks signatures with it. The daemon does not show it again; where it is lost, the webhook’s page gives another.</p>
    <pre tabIndex={0}><code>{secret}</code></pre>
    <p class="row"><button type="button" class="btn primary" onClick={() => copy(secret, 'The secret is')}>Copy</button><button type="button" class="btn" onClick={onSeen}>I have it</button><a href="/docs/webhooks">How a receiver checks it</a></p>
  </section>;
}
