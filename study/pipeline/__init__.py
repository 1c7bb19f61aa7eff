# What runs between the profile and the tidy tables; ../README.md says how the parts talk.
