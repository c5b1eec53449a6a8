// A figure that its page draws itself, marks without a common axis: a map, frames, a grid. It has the tools that every figure has.
import type {ComponentChildren, JSX} from 'preact';
import {useRef, useState} from 'preact/hooks';
import {csvOf, save, svgText, type Table} from './export';
import {TableView, Tools} from './Figure';

export interface DrawnProps {
  name: string;                 // of the files it is saved as
  title: string;
  sub?: ComponentChildren;
  controls?: ComponentChildren;
  more?: ComponentChildren;     // beside the tools
  table: () => Table;
  source: string;
  curl?: string;
  how?: () => JSX.Element;
  note?: ComponentChildren;
  children: ComponentChildren;  // one svg, or several that stand side by side in the file
}

export function Drawn({name, title, sub, controls, more, table, source, curl, how, note, children}: DrawnProps): JSX.Element {
  const box = useRef<HTMLDivElement>(null);
  const [tableShown, setTableShown] = useState(false);
  const drawings = (): SVGSVGElement[] => [...box.current?.querySelectorAll('svg') ?? []];
  return <section class="panel">
    <div class="ptop"><h2>{title}</h2>{controls}{sub && <span class="sub">{sub}</span>}{more}
      <Tools title={title} tableShown={tableShown} onTable={() => setTableShown(!tableShown)} curl={curl} how={how}
        onSvg={() => save(`${name}.svg`, 'image/svg+xml', svgText(drawings(), title, source))} onCsv={() => save(`${name}.csv`, 'text/csv', csvOf(table()))} />
    </div>
    <div class="drawn" ref={box}>{children}</div>
    {tableShown && <TableView table={table()} />}
    {note && <p class="note">{note}</p>}
  </section>;
}
