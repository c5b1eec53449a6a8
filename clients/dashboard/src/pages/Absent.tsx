import type {JSX} from 'preact';
import {here} from '../route';
import {useTitle} from '../shell/title';

export default function Absent(): JSX.Element {
  useTitle('No such page');
  return <>
    <h1>No such page</h1>
    <p class="verdict">There is nothing at <code>{here().path}</code>. <a href="/">The lab page</a> leads to everything there is.</p>
  </>;
}
