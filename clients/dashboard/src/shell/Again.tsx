// Leads from how something was computed to the form that asks for the same with other settings.
import type {JSX} from 'preact';
import {closeDrawer} from './Drawer';

export const RunAgain = ({job}: {job: string}): JSX.Element => <p class="no-print"><a class="btn" href={`/jobs/new?like=${job}`} onClick={closeDrawer}>Run again with other settings</a></p>;
