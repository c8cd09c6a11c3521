"""The process around the loop: threads, deadlines, systemd."""
