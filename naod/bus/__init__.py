"""zenoh: keys, session, publishing, remote calls."""
