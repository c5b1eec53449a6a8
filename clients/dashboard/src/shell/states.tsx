// Loading and refusal, as every panel shows them.
import type {ComponentChildren, JSX} from 'preact';
import {useEffect, useState} from 'preact/hooks';
import type {Problem, Read} from '../api/client';

const LATE_MS = 400;

export function Hairlines(): JSX.Element {
  const [late, setLate] = useState(false);
  useEffect(() => {
    const timer = setTimeout(() => setLate(true), LATE_MS);
    return () => clearTimeout(timer);
  }, []);
  return <div class="hairlines" aria-busy="true"><i /><i /><i />{late && <span class="dim">Loading</span>}</div>;
}

export function Refusal({problem, again}: {problem: Problem; again?: (() => void) | undefined}): JSX.Element {
  const {detail, type, title, retryable, request_id: request} = problem.document;
  return <div class="fault" role="alert">
    <span class="g bad" aria-hidden="true">✗</span>
    <div>{detail} {type && <a href={type}>{title}</a>} {retryable && again && <button type="button" class="link" onClick={again}>Try again</button>}
      {request && <small>request {request}</small>}</div>
  </div>;
}

// What was read, or how reading goes; a refusal to read it again stands above what was read before. `page`: what the page would show, where all of it rests on what is read.
export function Shown<T>({read, page, children}: {read: Read<T>; page?: string; children: (data: T) => ComponentChildren}): JSX.Element {
  const refusal = read.problem && <Refusal problem={read.problem} again={read.again} />;
  if (read.data !== undefined) return <>{refusal}{children(read.data)}</>;
  if (refusal) return <>{page && <h1>{page}</h1>}{refusal}</>;
  return <Hairlines />;
}

export function Panel({title, sub, tools, controls, children}: {title?: ComponentChildren; sub?: ComponentChildren; tools?: ComponentChildren; controls?: ComponentChildren; children: ComponentChildren}): JSX.Element {
  return <section class="panel">
    {title && <div class="ptop"><h2>{title}</h2>{controls}{sub && <span class="sub">{sub}</span>}{tools}</div>}
    {children}
  </section>;
}

export function Segments<T extends string>({label, options, value, onChange}: {label: string; options: readonly (readonly [T, string])[]; value: T; onChange: (value: T) => void}): JSX.Element {
  return <div class="seg" role="group" aria-label={label}>
    {options.map(([key, text]) => <button key={key} type="button" aria-pressed={key === value} onClick={() => onChange(key)}>{text}</button>)}
  </div>;
}

export function Progress({share, label}: {share: number; label: string}): JSX.Element {
  const percent = Math.round(Math.min(Math.max(share, 0), 1) * 100);
  return <div class="bar-p" role="progressbar" aria-label={label} aria-valuenow={percent} aria-valuemin={0} aria-valuemax={100}>
    <svg preserveAspectRatio="none" viewBox="0 0 100 4" aria-hidden="true"><rect width={percent} height="4" fill="var(--ink)" /></svg>
  </div>;
}
