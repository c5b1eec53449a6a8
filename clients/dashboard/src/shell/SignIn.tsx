// What is shown instead of a page where the daemon asks for a token. The token goes to the daemon once and comes back as a
// cookie that no script can read; nothing of it is kept here.
import type {JSX} from 'preact';
import {useState} from 'preact/hooks';
import {send, type Problem} from '../api/client';
import {Mark} from './Bar';
import {Refusal} from './states';

export function SignIn(): JSX.Element {
  const [token, setToken] = useState('');
  const [problem, setProblem] = useState<Problem | null>(null);
  const [busy, setBusy] = useState(false);
  const signIn = (event: Event): void => {
    event.preventDefault();
    setBusy(true);
    send('POST', '/v1/session', {token: token.trim()}).then(() => window.location.reload(), error => {
      setBusy(false);
      setProblem(error as Problem);
    });
  };
  return <main id="main" class="signin" tabIndex={-1}>
    <h1><Mark />driftlab</h1>
    <p>This daemon asks for a token. Whoever runs it gives you one.</p>
    <form onSubmit={signIn}>
      <label>Token <input type="password" name="token" autocomplete="current-password" required autofocus value={token}
        onInput={event => setToken(event.currentTarget.value)} /></label>
      <button type="submit" class="btn primary" disabled={busy}>Sign in</button>
    </form>
    {problem && <Refusal problem={problem} />}
    <p class="dim"><a href="/docs/security">What tokens are</a></p>
  </main>;
}
