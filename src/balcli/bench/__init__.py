"""Measure error against run time: of methods that compute the same orders, of peaks, of gas
harmonics, of torsion; and the time of a cold start. The command is `balcli bench`.
"""
