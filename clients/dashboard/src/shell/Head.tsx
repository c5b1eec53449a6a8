// The head of a page: where it is, what it is, one line of facts, what can be done.
import type {ComponentChildren, JSX} from 'preact';
import type {Summary} from '../api/documents';
import {writeSentence} from '../format/words';

export function Head({crumb, title, facts, actions}: {crumb?: readonly (readonly [string, string | null])[]; title: string; facts: ComponentChildren[]; actions?: ComponentChildren}): JSX.Element {
  return <>
    {crumb && <nav class="crumb" aria-label="Place">{crumb.map(([text, href], i) => <span key={text}>{i > 0 && ' / '}{href ? <a href={href}>{text}</a> : text}</span>)}</nav>}
    <div class="head">
      <div><h1>{title}</h1><div class="meta">{facts.filter(Boolean).map((fact, i) => <span key={i}>{fact}</span>)}</div></div>
      {actions && <div class="actions">{actions}</div>}
    </div>
  </>;
}

export function Verdict({summary, children}: {summary: Summary; children?: ComponentChildren}): JSX.Element {
  return <p class="verdict">
    {summary.level === 'wrong' && <span class="g bad">✗ </span>}{writeSentence(summary.verdict)}
    {(summary.details.length > 0 || children) && <small>{summary.details.map(writeSentence).join(' ')}{children}</small>}
  </p>;
}
