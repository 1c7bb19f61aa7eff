# From records to tables, figures and pages: README.md says how.
