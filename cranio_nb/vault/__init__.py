"""The skull seen from inside along rays: what real skulls need beyond the paper."""
