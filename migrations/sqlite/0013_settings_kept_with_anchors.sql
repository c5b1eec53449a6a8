-- Margins, scope and alpha that were fixed when a label became the anchor: a JSON object as regression runs write their
-- settings. Empty for anchors of before they were kept, whose runs are then told of no change.
ALTER TABLE anchors ADD COLUMN settings_json TEXT NOT NULL DEFAULT '';
