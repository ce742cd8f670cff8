"""The withheld-effect check: logs with hidden effects from an independent plant, diagnosed while their labels are sealed, then scored.

``plant``, ``planted``, ``missions`` and ``cases`` make the logs and share no code with the simulator and the diagnosis that are
tested; ``sealed`` is the protocol, ``baselines`` the simple methods that answer the same logs, ``scoring`` the comparison.
"""
