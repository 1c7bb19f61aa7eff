# The study: entry points (shell), profiles (data) and the pipeline (Python).
