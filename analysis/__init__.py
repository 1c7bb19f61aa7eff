# From tidy tables to statistics, figures and the report; README.md lists the parts.
