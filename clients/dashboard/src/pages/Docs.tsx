// The manual and the problem pages: Markdown made into elements, never into HTML text.
import type {ComponentChildren, JSX} from 'preact';
import {useEffect, useState} from 'preact/hooks';
import {ask, Problem, useRead} from '../api/client';
import {usePlace} from '../route';
import {Head} from '../shell/Head';
import {Hairlines, Panel, Refusal, Shown} from '../shell/states';
import {useTitle} from '../shell/title';

// Only addresses of this daemon, of the manual and of the web; nothing that runs.
function safe(href: string): string | null {
  if (/^https?:\/\//.test(href) || href.startsWith('/') || href.startsWith('#')) return href;
  return /^[\w-]+(\.md)?(#[\w-]*)?$/.test(href) ? `/docs/${href.replace(/\.md/, '')}` : null;
}

function inline(text: string): ComponentChildren[] {
  const parts: ComponentChildren[] = [];
  const pattern = /`([^`]+)`|\*\*([^*]+)\*\*|\*([^*\s][^*]*)\*|\[([^\]]+)\]\(([^)\s]+)\)/g;
  let at = 0;
  for (const match of text.matchAll(pattern)) {
    parts.push(text.slice(at, match.index));
    const [, code, strong, emphasis, label, href] = match;
    const target = href ? safe(href) : null;
    if (code) parts.push(<code>{code}</code>);
    else if (strong) parts.push(<b>{strong}</b>);
    else if (emphasis) parts.push(<em>{emphasis}</em>);
    else if (label) parts.push(target ? <a href={target}>{label}</a> : label);
    at = match.index + match[0].length;
  }
  parts.push(text.slice(at));
  return parts;
}

const cells = (line: string): string[] => line.replace(/^\||\|$/g, '').split('|').map(cell => cell.trim());

function Markdown({text}: {text: string}): JSX.Element {
  const lines = text.split('\n');
  const blocks: JSX.Element[] = [];
  let i = 0;
  const take = (while_: (line: string) => boolean): string[] => { const taken: string[] = []; while (i < lines.length && while_(lines[i]!)) taken.push(lines[i++]!); return taken; };
  while (i < lines.length) {
    const line = lines[i]!;
    const heading = /^(#{1,4}) (.*)/.exec(line);
    if (!line.trim()) { i++; }
    else if (line.startsWith('```')) { i++; const code = take(each => !each.startsWith('```')); i++; blocks.push(<pre tabIndex={0}><code>{code.join('\n')}</code></pre>); }
    else if (heading) { i++; const content = inline(heading[2]!); blocks.push(heading[1]!.length === 1 ? <h1>{content}</h1> : heading[1]!.length === 2 ? <h2>{content}</h2> : <h3>{content}</h3>); }
    else if (line.startsWith('|')) { const rows = take(each => each.startsWith('|')).filter(each => !/^\|[\s|:-]+$/.test(each)).map(cells); blocks.push(<div class="scroll"><table><thead><tr>{(rows[0] ?? []).map(cell => <th scope="col">{inline(cell)}</th>)}</tr></thead><tbody>{rows.slice(1).map(row => <tr>{row.map(cell => <td>{inline(cell)}</td>)}</tr>)}</tbody></table></div>); }
    else if (/^\s*[-*] /.test(line)) { const items: string[] = []; for (const each of take(l => /^\s*[-*] /.test(l) || /^\s{2,}\S/.test(l))) { if (/^\s*[-*] /.test(each)) items.push(each.replace(/^\s*[-*] /, '')); else items[items.length - 1] += ` ${each.trim()}`; } blocks.push(<ul>{items.map(item => <li>{inline(item)}</li>)}</ul>); }
    else { blocks.push(<p>{inline(take(each => Boolean(each.trim()) && !/^(#|```|\||\s*[-*] )/.test(each)).join(' '))}</p>); }
  }
  return <article class="doc">{blocks}</article>;
}

function Page({path}: {path: string}): JSX.Element {
  const [text, setText] = useState<string>();
  const [problem, setProblem] = useState<Problem>();
  useEffect(() => {
    setText(undefined);
    ask(path, {headers: {Accept: 'text/markdown'}}).then(answer => answer.text()).then(setText, error => setProblem(error as Problem));
  }, [path]);
  return problem ? <><h1>Manual</h1><Refusal problem={problem} /></> : text === undefined ? <Hairlines /> : <Panel><Markdown text={text} /></Panel>;
}

function Contents(): JSX.Element {
  const read = useRead<{pages: {name: string; href: string}[]; problems: {slug: string; href: string}[]}>('/docs');
  return <>
    <Head title="Manual" facts={['what the daemon does and says']} />
    <Shown read={read}>{list => <div class="grid two"><Panel title="Pages"><ul class="links">{list.pages.map(page => <li key={page.name}><a href={page.href}>{page.name}</a></li>)}</ul></Panel><Panel title="Problems"><ul class="links">{list.problems.map(problem => <li key={problem.slug}><a href={problem.href}>{problem.slug.replace(/-/g, ' ')}</a></li>)}</ul></Panel></div>}</Shown>
  </>;
}

export default function Docs(): JSX.Element {
  const {parts, path} = usePlace();
  useTitle(parts[1] ?? 'Manual');
  return parts[1] ? <><nav class="crumb" aria-label="Place"><a href="/docs">Manual</a> / {parts[1]}</nav><Page path={path} /></> : <Contents />;
}
