"""Smooth curves through clogging lengths: lambda against one or two keys of a sweep.

- model: the Gaussian process that is fitted, on numbers alone
- features: band, peak and crossings of a fitted curve
- points: which groups of clogfit's table belong to a curve, and why others do not
- answer: the curves of a sweep, as `clogfit curve --format json` prints them
- table: these curves as text and CSV
"""
