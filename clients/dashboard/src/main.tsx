// Where the dashboard begins. build.mjs puts the file that holds app.tsx into the document itself, without this step between.
import './app';
