"""The NAO's own numbers: joints, links, postures, head limits, feet and cameras."""
