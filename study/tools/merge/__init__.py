# study/merge: which conclusions of several sets of one commit hold on all of their machines.
