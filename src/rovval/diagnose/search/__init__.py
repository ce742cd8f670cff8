"""The search: which causes, added to the healthy vehicle one after the other and weighed beside each other, explain the gap."""
